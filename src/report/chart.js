'use strict';
// The front as a chart of selectable dots: a radio group for keyboard and screen reader.

function svg(name, attributes, text) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  return node;
}

function niceTicks(low, high, wanted) {
  const rough = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= rough);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push(k * step);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return ticks.map((value) => ({ value, text: value.toFixed(digits) }));
}

function measured(network, measure) {
  return measure.count ? network.stations.length : network.values[measure.name].value;
}

function described(report, network) {
  const told = report.measures.filter((m) => !m.count && network.values[m.name] && network.values[m.name].value !== null)
    .map((m) => `${m.name.replace(/_/g, ' ')} ${network.values[m.name].value.toFixed(3)}${m.unit ? ' ' + m.unit : ''}`);
  return `${network.stations.length} stations, ${told.join(', ')}`;
}

// Axes with a grid and titles, around a field `left`, `right`, `top` and `bottom` of which stay free.
function gridChart({ width, height, left, right, top, bottom }, xTicks, yTicks, px, py, xTitle, yTitle, attributes) {
  const chart = svg('svg', { viewBox: `0 0 ${width} ${height}`, ...attributes });
  for (const t of xTicks) {
    chart.append(svg('line', { class: 'grid', x1: px(t.value), x2: px(t.value), y1: top, y2: height - bottom }));
    chart.append(svg('text', { x: px(t.value), y: height - bottom + 20, 'text-anchor': 'middle' }, t.text));
  }
  for (const t of yTicks) {
    chart.append(svg('line', { class: 'grid', x1: left, x2: width - right, y1: py(t.value), y2: py(t.value) }));
    chart.append(svg('text', { x: left - 9, y: py(t.value) + 4.5, 'text-anchor': 'end' }, t.text));
  }
  chart.append(svg('path', { class: 'axis', fill: 'none', d: `M${left} ${top}V${height - bottom}H${width - right}` }));
  chart.append(svg('text', { x: (left + width - right) / 2, y: height - 12, 'text-anchor': 'middle' }, xTitle));
  chart.append(svg('text', { transform: `translate(18 ${(top + height - bottom) / 2}) rotate(-90)`, 'text-anchor': 'middle' }, yTitle));
  return chart;
}

// Stations against what they capture: a line with the plan and the knee marked.
function tradeOffChart(holder, points) {
  const width = Math.max(320, holder.clientWidth), height = 260, left = 66, right = 40, top = 26, bottom = 58;
  const last = points[points.length - 1].stations;
  const px = (n) => left + (n / last) * (width - left - right), py = (share) => height - bottom - share * (height - top - bottom);
  const shares = [0, 0.25, 0.5, 0.75, 1].map((value) => ({ value, text: `${100 * value} %` }));
  const chart = gridChart({ width, height, left, right, top, bottom }, niceTicks(0, last, width < 500 ? 4 : 8).filter((t) => Number.isInteger(t.value)),
    shares, px, py, 'Stations', 'Captured', { role: 'img', 'aria-label': 'Stations against what they capture; the table below has the numbers' });
  chart.append(svg('path', { class: 'trade-off', fill: 'none', d: points.map((p, k) => `${k ? 'L' : 'M'}${px(p.stations).toFixed(1)} ${py(p.capture).toFixed(1)}`).join('') }));
  for (const p of points) {
    const name = p.answer ? `${p.stations}: the plan` : p.knee ? `${p.stations}: knee` : '';
    const dot = svg('circle', { class: name ? 'dot' : 'dot small', cx: px(p.stations), cy: py(p.capture), r: name ? 6.5 : 3.5 });
    dot.append(svg('title', {}, `${p.stations} stations, ${(100 * p.capture).toFixed(1)} %`));
    chart.append(dot);
    if (name) chart.append(svg('text', { x: px(p.stations), y: py(p.capture) + 26, 'text-anchor': 'middle' }, name));
  }
  holder.replaceChildren(chart);
}

// Returns select(k), which marks a network. `pick(k)` is called when a dot is picked.
function frontChart(holder, report, pick) {
  const [x, y, third] = report.axes;
  const dots = report.networks.map((network, k) => ({ k, x: measured(network, x), y: measured(network, y), c: third ? measured(network, third) : 0 }))
    .filter((dot) => Number.isFinite(dot.x) && Number.isFinite(dot.y));
  const width = Math.max(320, holder.clientWidth), narrow = width < 500, height = 330;
  const left = 66, right = !third ? 24 : narrow ? 96 : 170, top = 26, bottom = 58;
  const range = (key, whole) => {
    const values = dots.map((dot) => dot[key]);
    let low = Math.min(...values), high = Math.max(...values);
    const pad = whole ? 0.5 : Math.max(0.08 * (high - low), 1e-3 * Math.max(1, Math.abs(high)));
    return [low - pad, high + pad];
  };
  const [x0, x1] = range('x', x.count), [y0, y1] = range('y', y.count);
  const px = (v) => left + ((v - x0) / (x1 - x0)) * (width - left - right);
  const py = (v) => height - bottom - ((v - y0) / (y1 - y0)) * (height - top - bottom);
  const ticks = (axis, low, high, wanted) => niceTicks(low, high, wanted).filter((t) => !axis.count || Number.isInteger(t.value));
  const xTicks = ticks(x, x0, x1, narrow ? 4 : 8).map((t) => ({ value: t.value, text: x.count ? String(Math.round(t.value)) : t.text }));
  const title = (axis) => (narrow ? axis.name.replace(/_/g, ' ') : axis.label) + (axis.unit ? ` (${axis.unit})` : '');
  const chart = gridChart({ width, height, left, right, top, bottom }, xTicks, ticks(y, y0, y1, 5), px, py, title(x), title(y),
    { role: 'radiogroup', 'aria-label': `Networks by ${x.label} and ${y.label}` });

  const low = Math.min(...dots.map((dot) => dot.c)), high = Math.max(...dots.map((dot) => dot.c));
  const rising = ['#440154', '#3b528b', '#21918c', '#5ec962', '#d9c71c'];  // viridis, its pale end darker
  const shade = (c) => rising[Math.round(4 * (high > low ? (c - low) / (high - low) : 0))];
  if (third) {
    chart.append(svg('text', { x: width - right + 22, y: top + 8 }, third.name.replace(/_/g, ' ')));
    rising.forEach((colour, k) => {
      chart.append(svg('circle', { cx: width - right + 30, cy: top + 32 + 24 * k, r: 6, fill: colour }));
      const value = low + ((high - low) * k) / 4;
      chart.append(svg('text', { x: width - right + 44, y: top + 37 + 24 * k }, value.toFixed(third.count ? 0 : 3)));
    });
  }
  // In the order of the arrow keys: to the right.
  dots.sort((a, b) => a.x - b.x || b.y - a.y);
  dots.forEach((dot, place) => {
    const network = report.networks[dot.k], isAnswer = dot.k === report.answer;
    const group = svg('g', { role: 'radio', tabindex: -1, 'aria-checked': 'false',
      'aria-label': `Network ${dot.k + 1}${isAnswer ? ', proposed' : ''}: ${described(report, network)}` });
    if (isAnswer) group.classList.add('answer');
    if (network.dominated) group.classList.add('dominated');
    group.append(svg('title', {}, described(report, network)), svg('circle', { class: 'ring', cx: px(dot.x), cy: py(dot.y), r: 12 }));
    const mark = svg('circle', { class: 'dot', cx: px(dot.x), cy: py(dot.y), r: 6.5 });
    if (third) mark.style.fill = shade(dot.c);
    group.append(mark);
    if (isAnswer) group.append(svg('text', { x: px(dot.x), y: py(dot.y) - 17, 'text-anchor': 'middle' }, 'proposed'));
    group.addEventListener('click', () => pick(dot.k));
    group.addEventListener('keydown', (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1, Home: -place, End: dots.length - 1 - place }[event.key];
      if (step === undefined && event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      const next = dots[(place + (step || 0) + dots.length) % dots.length];
      pick(next.k);
      next.group.focus();
    });
    dot.group = group;
    chart.append(group);
  });
  holder.replaceChildren(chart);
  return (k) => dots.forEach((dot) => {
    dot.group.setAttribute('aria-checked', String(dot.k === k));
    dot.group.setAttribute('tabindex', dot.k === k ? 0 : -1);
  });
}
