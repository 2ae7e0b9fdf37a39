'use strict';
// Assembles the page: it shows one network at a time, and everything follows it.

(async () => {
  const report = JSON.parse(document.getElementById('report').textContent);
  const at = (id) => document.getElementById(id);
  let network = null, current = -1, selected = null, view = null, mark = () => {}, only = null;

  VIEW_COLOURS.reasons = report.missed.reasons.map((r) => `rgb(${r.rgb.join()})`);
  at('title').textContent = report.title;
  at('question').textContent = report.question;
  at('command').textContent = report.command;
  at('date').textContent = report.date ? `· ${report.date}` : '';
  if (report.logo) {
    at('logo').src = report.logo;
    at('logo').hidden = false;
  }
  at('footer').textContent = `Made by vantage ${report.version}. Heights and places are those of the site’s model.`;
  parameterTable(at('parameters'), report.parameters);
  if (report.missed.nodes.length) missedTable(at('missed'), at('missed-words'), report.missed);
  else at('missed-section').hidden = true;

  function pick(k) {
    selected = k === selected ? null : k;
    if (view) {
      if (view.standing) stepBack();
      view.select(selected);
    }
    at('stations').querySelectorAll('[data-station]').forEach((name) => name.closest('tr').classList.toggle('picked', Number(name.dataset.station) === selected));
    card();
  }
  function card() {
    // A station's own cells among all shown ones.
    const share = only && selected !== null ? only.reduce((n, v) => n + (v === selected + 1), 0) / only.length : null;
    stationCard(at('station'), network, selected, share, { pick, stand: view ? stand : null });
  }
  function stand(k) {
    view.stand(k);
    at('leave').hidden = false;
    at('leave').focus();
  }
  function stepBack() {
    view.leave();
    at('leave').hidden = true;
  }

  async function show(k) {
    current = k;
    network = report.networks[k];
    selected = null;
    mark(k);
    at('which').textContent = `Network ${k + 1} of ${report.networks.length}`;
    at('to-answer').disabled = k === report.answer;
    figures(at('figures'), network);
    words(at('words'), network, k === report.answer && report.missed.nodes.length ? report.missed : null);
    // What holds of the answer alone is left out of other networks.
    factWords(at('facts'), report.facts.filter((f) => k === report.answer || !['stations', 'at each', 'in all'].includes(f.heading)));
    stationTable(at('stations'), network, pick);
    at('round').textContent = roundWords(network);
    sessionTable(at('sessions'), network);
    targetTable(at('targets'), network);
    at('targets-section').hidden = !network.targets.length;
    accuracyTable(at('accuracy'), at('accuracy-words'), k === report.answer ? report.accuracy : null);
    at('accuracy-section').hidden = k !== report.answer || !report.accuracy;
    roomTable(at('rooms'), report.rooms);
    at('rooms-section').hidden = k !== report.answer || !report.rooms.length;
    elementTable(at('elements'), at('elements-words'), report.elements);
    at('elements-section').hidden = k !== report.answer || !report.elements.rows.length;
    linkTable(at('links'), at('links-words'), network);
    valuesTable(at('values'), report, network);
    only = null;
    if (view) {
      view.setNetwork(network.stations, network.links || [], network.visit, network.targets);
      const kept = report.view.cells && report.view.cells.networks[k];
      const [coverage, alone] = kept ? await Promise.all([unpack(kept.coverage), unpack(kept.only)]) : [null, null];
      if (current !== k) return;  // another was picked meanwhile
      view.setColours(coverage, alone);
      only = alone;
      legend(kept);
    }
    card();
  }

  function legend(kept) {
    const mode = view.wanted, items = [];
    const item = (style, text, kind = '') => items.push(element('span', {}, element('i', { class: kind, style }), text));
    if (mode === 'coverage' && view.known) {
      const nothing = element('span', {}, 'no points', element('i', { class: 'ramp', style: `background:linear-gradient(90deg,${VIEW_COLOURS.ramp.join()})` }), 'wanted density');
      items.push(nothing);
      if (report.view.cells.reasons) item('', 'no place to stand could help', 'hatch');
    } else if (mode === 'why') {
      report.missed.reasons.forEach((r, k) => item(`background:${VIEW_COLOURS.reasons[k]}`, r.words));
    }
    if (mode === 'coverage' && !view.known) items.push(element('span', {}, 'The colours of this network are not kept in this page.'));
    if (mode !== 'plain') item(`background:${VIEW_COLOURS.blocking}`, 'not surveyed');
    if (view.known && mode !== 'plain') item(`background:${VIEW_COLOURS.only}`, 'only the picked station sees');
    item(`background:${VIEW_COLOURS.link}`, 'link', 'stroke');
    if (network.targets.length)
      item(`background:conic-gradient(${VIEW_COLOURS.target[1]} 25%,${VIEW_COLOURS.target[0]} 0 50%,${VIEW_COLOURS.target[1]} 0 75%,${VIEW_COLOURS.target[0]} 0);border-radius:50%;border:1.5px solid ${VIEW_COLOURS.target[0]}`, 'target or control point', 'disc');
    if (network.visit && (network.visit.sessions || network.visit.ways.length)) item(`background:${VIEW_COLOURS.route}`, 'the round', 'stroke');
    item(`background:repeating-linear-gradient(90deg,${VIEW_COLOURS.bridge} 0 6px,transparent 6px 9px)`, 'bridge', 'stroke');
    if (kept && kept.sample > 0 && mode === 'coverage') items.push(element('span', { class: 'muted' }, `colours from a sample of ${grouped(kept.sample)} voxels`));
    at('legend').replaceChildren(...items);
  }

  function setUpTools() {
    sliceTools(view, report.view.levels, report.view.origin[2], report.networks[report.answer].stations);
    at('oblique').addEventListener('click', () => { stepBack(); view.oblique(); });
    at('above').addEventListener('click', () => { stepBack(); view.above(); });
    at('leave').addEventListener('click', stepBack);
    const modes = [...at('modes').querySelectorAll('button')].filter((button) => {
      const possible = button.dataset.mode !== 'why' || (report.view.cells && report.view.cells.reasons);
      button.hidden = !possible;
      return possible;
    });
    const choose = (button) => {
      modes.forEach((other) => { other.setAttribute('aria-checked', String(other === button)); other.tabIndex = other === button ? 0 : -1; });
      view.setMode(button.dataset.mode);
      legend(report.view.cells && report.view.cells.networks[current]);
    };
    modes.forEach((button, k) => {
      button.addEventListener('click', () => choose(button));
      button.addEventListener('keydown', (event) => {
        const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
        if (!step) return;
        event.preventDefault();
        const next = modes[(k + step + modes.length) % modes.length];
        next.focus();
        choose(next);
      });
    });
    modes.forEach((button, k) => { button.setAttribute('aria-checked', String(k === 0)); button.tabIndex = k === 0 ? 0 : -1; });
  }

  if (report.trade_off.length) {
    at('trade-off').hidden = false;
    tradeOffChart(at('trade-off-chart'), report.trade_off);
    at('registration-jump').textContent = report.registration_jump;
    at('trade-off-table').replaceChildren(table(['Stations', 'Captured', 'Registered to', 'On site', ''], report.trade_off.map((p) => [
      p.stations, `${percent(p.capture)} ± ${percent(p.capture_se)}`, p.registration === null ? null : `${tenths(p.registration)} mm`,
      p.minutes_on_site === null ? null : duration(60 * p.minutes_on_site), p.answer ? 'the plan' : p.knee ? 'knee' : '']), [4]));
  }
  if (report.axes.length) {
    at('front').hidden = false;
    mark = frontChart(at('chart'), report, show);
    const step = (by) => show((current + by + report.networks.length) % report.networks.length);
    at('previous').addEventListener('click', () => step(-1));
    at('next').addEventListener('click', () => step(1));
    at('to-answer').addEventListener('click', () => show(report.answer));
  }
  try {
    view = new SiteView(at('canvas'), report.view, pick, report.crs);
    await view.load();
    setUpTools();
  } catch (error) {
    if (window.WebGL2RenderingContext && window.DecompressionStream && view) console.error(error);
    view = null;
    at('view').hidden = true;
    at('no-view').hidden = false;
  }
  await show(report.answer);
  if (view) view.oblique();  // with its stations in sight
  window.addEventListener('beforeprint', () => {
    at('parameters').open = true;
    if (view) view.picture();
  });
  document.documentElement.dataset.ready = 'true';
})();
