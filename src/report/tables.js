'use strict';
// Tables and words. All text is inserted as text, never as markup.

function element(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === 'style') node.style.cssText = value; // the page's policy forbids the attribute of that name
    else node.setAttribute(key, value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

const percent = (share, digits = 1) => `${(100 * share).toFixed(digits)} %`;
const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, '\u2009');
const metres = (v) => v.toFixed(3);
const tenths = (mm) => (mm < 0.05 ? 'less than 0.1' : mm.toFixed(1)); // of a prediction, whose hundredths mean nothing
function duration(seconds) {
  const minutes = Math.round(seconds / 60);
  return minutes < 60 ? `${minutes} min` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

function table(titles, rows, textColumns = []) {
  const cell = (name, content, k) => {
    const node = element(name, textColumns.includes(k) ? { class: 'text' } : {});
    node.append(content === null || content === undefined ? '–' : content);
    if (name === 'th') node.scope = 'col';
    return node;
  };
  return element('table', {}, element('thead', {}, element('tr', {}, ...titles.map((t, k) => cell('th', t, k)))),
    element('tbody', {}, ...rows.map((row) => element('tr', {}, ...row.map((c, k) => cell('td', c, k))))));
}

// A link is weak within a quarter above the least value of a link.
const weak = (network, link) => link.value < 1.25 * network.least_link;

function figures(holder, network) {
  const used = network.stations.filter((s) => s.active).length, kept = network.stations.filter((s) => s.existing).length;
  const tile = (name, value, note, bad) =>
    element('div', bad ? { class: 'bad' } : {}, element('dt', {}, name), element('dd', {}, value, element('small', {}, note)));
  const tiles = [
    network.captured !== null
      ? tile('Captured', percent(network.captured), `of what is attainable; ${percent(network.coverage)} of the site`)
      : tile('Captured', percent(network.coverage), 'of the site’s surfaces; where points are too few, in part'),
    tile('Stations', String(used), kept ? `${kept} there already, ${used - kept} new` : 'all new'),
  ];
  if (network.parts !== null)
    tiles.push(network.parts === 1
      ? tile('Connected', 'Yes', used === 1 ? 'one station' : `all stations, by ${network.link_measure} of ${network.least_link} and more`)
      : tile('Connected', 'No', `in ${network.parts} parts that share no link`, true));
  const registered = network.values.registration;
  if (registered)
    tiles.push(registered.value === null
      ? tile('Registered', 'Not known', 'surfaces do not hold the scans together', true)
      : tile('Registered', `${tenths(registered.value)} mm`, `${!network.confirmed && registered.standard_error >= 0.05 ? `± ${tenths(registered.standard_error)} mm, ` : ''}predicted error of the scans`
        + (network.random_mm === null ? '' : network.random_mm < registered.value ? `, random ${tenths(network.random_mm)} mm` : ', random alone')));
  const sessions = sessionsOf(network);
  if (sessions.length) {
    const days = Math.max(...sessions.map((s) => s.day)), crews = Math.max(...sessions.map((s) => s.crew));
    tiles.push(tile('On site', `${days} day${days > 1 ? 's' : ''}`, `${sessions.length} session${sessions.length > 1 ? 's' : ''}${crews > 1 ? ` of ${crews} crews` : ''}, `
      + `the longest ${duration(60 * Math.max(...sessions.map((s) => s.minutes)))}`));
  } else if (network.minutes_on_site !== null) tiles.push(tile('On site', duration(60 * network.minutes_on_site), 'with setting up and walking'));
  holder.replaceChildren(...tiles);
}

// "57.2 % hidden from everywhere, 2.1 % …", the largest share first; of all surfaces of the proposed network.
function missedWords(missed) {
  const { shares } = missed.nodes[0];
  return missed.reasons.map((r, k) => [shares[k], r.words]).slice(1).filter(([s]) => s >= 5e-4).sort((a, b) => b[0] - a[0])
    .map(([s, text]) => `${percent(s)} ${text}`).join(', ');
}

// `missed`: of this network, or null. Both lines contain partly captured surface, so the second names its denominator.
function words(holder, network, missed) {
  const lines = [...network.summary];
  const told = missed ? missedWords(missed) : '';
  if (told) lines.splice(1, 0, { heading: 'missed', text: `${percent(1 - missed.nodes[0].shares[0])} in part or all: ${told}` });
  // Advice that is more than one can read at once is folded.
  const kAdvice = 8, folded = lines.filter((line) => line.heading === 'to do').slice(kAdvice);
  const shown = lines.filter((line) => !folded.includes(line));
  const pairs = shown.flatMap(({ heading, text }, k) => {
    const repeated = k > 0 && shown[k - 1].heading === heading;
    const name = heading[0].toUpperCase() + heading.slice(1);
    const title = element('dt', heading === 'to do' ? { class: 'todo' } : {}, repeated ? element('span', { class: 'hidden' }, name) : name);
    return [title, element('dd', {}, text[0].toUpperCase() + text.slice(1))];
  });
  if (folded.length)
    pairs.push(element('dt', {}), element('dd', {}, element('details', { class: 'more' }, element('summary', {}, `${folded.length} more to do`),
      ...folded.map(({ text }) => element('div', {}, text[0].toUpperCase() + text.slice(1))))));
  holder.replaceChildren(...pairs);
}

// A table of which some rows show and the rest can be unfolded; made when they are.
function foldedTable(titles, rows, textColumns, most, words) {
  const shown = table(titles, rows.slice(0, most), textColumns);
  if (rows.length <= most) return [shown];
  const more = element('details', { class: 'more' }, element('summary', {}, words(rows.length - most)));
  more.addEventListener('toggle', () => {
    if (more.open && more.children.length === 1) more.append(table(titles, rows.slice(most), textColumns));
  });
  return [shown, more];
}

const kRows = 60;  // that a page shows at once

const sessionsOf = (network) => (network.visit && network.visit.sessions) || [];
const sessionName = (session) => `Day ${session.day}, crew ${session.crew}`;

// The place of a station in its session, or in the round; null: nowhere.
function stopOf(network, k) {
  for (const round of sessionsOf(network).length ? sessionsOf(network) : network.visit ? [network.visit] : []) {
    const stop = round.order.indexOf(k);
    if (stop >= 0) return { session: round.day ? sessionName(round) : null, stop: stop + 1, of: round.order.length, walk: round.legs_m[stop].toFixed(1), begin: round.begin ? round.begin[stop] : null };
  }
  return null;
}

// By their place in the round, the others behind them.
function visitingOrder(network) {
  const order = network.visit ? [...network.visit.order] : [], visited = new Set(order);
  network.stations.forEach((s, k) => { if (!visited.has(k)) order.push(k); });
  return order;
}

function stationTable(holder, network, pick, order = visitingOrder(network)) {
  const round = network.visit && network.visit.order.length > 0, sessions = sessionsOf(network).length > 0;
  const targets = network.targets.length > 0, known = network.stations.some((s) => s.set_up !== undefined);
  const seen = (k) => network.targets.filter((t) => t.stations.includes(k)).map((t) => t.name).join(', ') || null;
  const row = (k) => {
    const s = network.stations[k];
    const name = element('button', { type: 'button', 'data-station': k }, s.name);
    name.addEventListener('click', () => pick(k));
    const cells = [name, ...(s.position || [null, null, null]).map((v) => (v === null ? null : metres(v))), s.ground ? metres(s.ground[2]) : null,
      s.points_on_surveyed === null ? null : grouped(s.points_on_surveyed), s.linked === undefined ? null : s.linked];
    if (targets) cells.push(seen(k));
    if (known) cells.push(s.set_up);
    if (round) {
      const at = stopOf(network, k) || { session: null, stop: null, walk: null, begin: null };
      cells.push(...(sessions ? [at.session] : []), at.stop, ...(sessions ? [at.begin] : []), at.walk);
    }
    return [...cells, s.existing ? element('span', { class: 'tag' }, 'there before') : s.fault ? element('span', { class: 'tag weak' }, s.fault) : ''];
  };
  const titles = ['Name', 'x (m)', 'y (m)', 'Head z (m)', 'Ground z (m)', 'Points on the site', 'Links', ...(targets ? ['Targets to see'] : []), ...(known ? ['By known points'] : []), ...(sessions ? ['Session'] : []), ...(round ? ['Stop', ...(sessions ? ['Begin'] : []), 'Walk (m)'] : []), ''];
  holder.replaceChildren(...foldedTable(titles, order.map(row), [titles.length - 1], kRows, (n) => `${n} more stations`));
}

function targetTable(holder, network) {
  const kind = (t) => (t.sigma_m !== null ? `control point, known to ${1e3 * t.sigma_m} mm` : t.check ? 'check of the vertical index' : t.proposed ? 'proposed' : 'there before');
  holder.replaceChildren(table(['Name', 'x (m)', 'y (m)', 'z (m)', 'Kind', 'Measured by'], network.targets.map((t) => [t.name, ...t.position.map(metres), kind(t),
    t.stations.length ? t.stations.map((k) => network.stations[k].name).join(', ') : element('span', { class: 'tag weak' }, 'no station')]), [0, 4, 5]));
}

// `accuracy`: of the report, or null.
function accuracyTable(holder, wordsHolder, accuracy) {
  if (!accuracy) return;
  wordsHolder.textContent = `Predicted registration error at 95 % by ${accuracy.by}, the worst first; ${accuracy.class} allows ${accuracy.allowed_mm} mm.`;
  const kShown = 20;
  holder.replaceChildren(...foldedTable([accuracy.by === 'room' ? 'Room' : 'Mesh', 'Mean (mm)', 'Worst place (mm)', 'Beyond the class', ''],
    accuracy.rows.map((r) => [r.name, tenths(r.mean_mm), tenths(r.worst_mm), percent(r.beyond),
      r.beyond > 0 ? element('span', { class: 'tag weak' }, 'not met') : accuracy.class === 'LOA50' ? 'predicted' : 'met']), [0, 4], kShown, (n) => `${n} more`));
}

function roomTable(holder, rooms) {
  holder.replaceChildren(...foldedTable(['Room', 'Storey', 'Floor (m²)', 'Captured', 'Stations'],
    rooms.map((r) => [r.name, r.storey || null, r.floor_m2.toFixed(1), r.captured === null ? null : percent(r.captured), r.stations || `none: ${r.why_no_station}`]),
    [0, 1, 4], kRows, (n) => `${n} more rooms`));
}

function elementTable(holder, wordsHolder, { all, rows }) {
  const kShown = 20, deviation = rows.some((r) => r.deviation_mm !== null), known = (value, text) => (value === null ? null : text(value));
  wordsHolder.textContent = 'Each element of the model, or mesh: the share of its wanted points, the median incidence and point distance where it is seen'
    + `${deviation ? ', and the predicted registration error there' : ''}; those with most surface that is not captured first.${all > rows.length ? ` ${rows.length} of ${all}; elements.csv has all.` : ''}`;
  holder.replaceChildren(...foldedTable(['Element', 'Surface (m²)', 'Captured', 'Incidence (°)', 'Point distance (mm)', ...(deviation ? ['Deviation (mm)'] : [])],
    rows.map((r) => [r.name, r.area_m2.toFixed(1), percent(r.captured), known(r.incidence, (v) => v.toFixed(0)), known(r.point_distance_mm, (v) => v.toFixed(1)),
      ...(deviation ? [known(r.deviation_mm, tenths)] : [])]), [0], kShown, (n) => `${n} more elements`));
}

// The round in a sentence.
function roundWords(network) {
  if (sessionsOf(network).length) return 'Each session begins and ends at the entrance; stops and walks below are of the sessions.';
  if (!network.visit) return '';
  const { order, walk_m: walk, ways } = network.visit, kNamed = 40;
  const names = order.slice(0, kNamed).map((k) => network.stations[k].name).join(' → ');
  return `The round${ways.length && ways[0].length > 3 ? ' from the entrance' : ''}: ${names}${order.length > kNamed ? ` → … ${order.length} stations in all` : ''}, and back: ${walk.toFixed(0)} m on foot.`;
}

function sessionTable(holder, network) {
  const sessions = sessionsOf(network), kNamed = 12;
  const names = ({ order }) => order.slice(0, kNamed).map((k) => network.stations[k].name).join(' → ') + (order.length > kNamed ? ` → … ${order.length} in all` : '');
  holder.hidden = !sessions.length;
  const waits = sessions.some((s) => s.waiting_min > 0), batteries = sessions.some((s) => s.batteries);
  const titles = ['Session', 'Time', 'Stations', 'At stations', 'Walking', ...(waits ? ['Waiting'] : []), 'In all', ...(batteries ? ['Batteries'] : []), 'Links'];
  holder.replaceChildren(table(titles, sessions.map((s) => [sessionName(s), s.clock, names(s),
    duration(60 * (s.minutes - s.walk_min - s.waiting_min)), `${duration(60 * s.walk_min)}, ${s.walk_m.toFixed(0)} m`, ...(waits ? [s.waiting_min > 0 ? duration(60 * s.waiting_min) : ''] : []),
    duration(60 * s.minutes), ...(batteries ? [s.batteries] : []), s.links]), [0, 1, 2, titles.length - 1]));
}

function linkTable(holder, wordsHolder, network) {
  if (!network.links) {
    wordsHolder.textContent = 'How scans overlap was not measured.';
    holder.replaceChildren();
    return;
  }
  const weakestFirst = (l, r) => Number(r.bridge) - Number(l.bridge) || l.value - r.value;
  const tree = network.links.filter((l) => l.tree || l.bridge).sort(weakestFirst), rest = network.links.filter((l) => !l.tree && !l.bridge).sort(weakestFirst);
  wordsHolder.textContent = `The links that the survey depends on: the strongest that connect all stations, by ${network.link_measure} of at least ${network.least_link}; bridges first, then the weakest. `
    + 'A bridge is the only link between two parts: lose it, and the survey falls apart. Weak: within a quarter of the least that counts.';
  const row = (l) => {
    const tags = [];
    if (l.bridge) tags.push(element('span', { class: 'tag bridge' }, 'bridge'), ' ');
    if (weak(network, l)) tags.push(element('span', { class: 'tag weak' }, 'weak'), ' ');
    if (l.weakest) tags.push(element('span', { class: 'tag' }, 'weakest that the survey depends on'));
    const cell = element('span', {});
    cell.append(...tags);
    return [network.stations[l.a].name, network.stations[l.b].name, l.voxels === undefined ? percent(l.value) : `${percent(l.value)} ± ${percent(l.error)}, of ${grouped(l.voxels)} voxels`, cell];
  };
  if (!network.links.length) {
    holder.replaceChildren(element('p', {}, 'No two stations are linked.'));
    return;
  }
  const titles = ['From', 'To', network.link_measure === 'overlap' ? 'Overlap' : 'Scan overlap', ''], text = [0, 1, 3], kTree = 12;
  const most = Math.min(kRows, Math.max(kTree, tree.filter((l) => l.bridge).length));
  const parts = foldedTable(titles, tree.map(row), text, most, (n) => `${n} more that the survey depends on`);
  if (rest.length) {
    const others = network.all_links - tree.length;
    parts.push(...foldedTable(titles, rest.map(row), text, 0, () => `${others} further links${others > rest.length ? `, the ${rest.length} strongest` : ''}`).slice(1));
  }
  holder.replaceChildren(...parts);
}

function factWords(holder, facts) {
  const first = (text) => text[0].toUpperCase() + text.slice(1);
  holder.replaceChildren(...facts.flatMap(({ heading, text }) => [element('dt', {}, first(heading)), element('dd', {}, text)]));
}

function missedTable(holder, wordsHolder, missed) {
  const [all, ...nodes] = missed.nodes;
  const share = (node, name) => node.shares[missed.reasons.findIndex((r) => r.name === name)];
  const told = missedWords(missed);
  wordsHolder.textContent = `Of the proposed network: ${percent(share(all, 'captured'))} of the surfaces are captured; `
    + (told ? told + '. ' : '')
    + 'Only what other stations would capture can be helped by more of them.';
  nodes.sort((a, b) => b.voxels * (1 - share(b, 'captured')) - a.voxels * (1 - share(a, 'captured')));
  const row = (node, name) => {
    const bar = element('span', { class: 'bar', 'aria-hidden': 'true' });
    node.shares.forEach((s, k) => bar.append(element('i', { style: `width:${100 * s}%;background:${VIEW_COLOURS.reasons[k]}` })));
    return [name, bar, ...node.shares.map((s) => (100 * s).toFixed(1))];
  };
  const kMeshes = 15;
  holder.replaceChildren(...foldedTable(['Mesh', '', ...missed.reasons.map((r) => r.words[0].toUpperCase() + r.words.slice(1) + ' (%)')],
    [row(all, 'All'), ...nodes.map((node) => row(node, node.node || '(no name)'))], [1], kMeshes, (n) => `${n} more meshes`));
}

function valuesTable(holder, report, network) {
  const rows = report.measures.filter((m) => network.values[m.name]).map((m) => {
    const { value, standard_error: error } = network.values[m.name];
    return [m.label, value === null ? null : value.toFixed(4) + (error > 0 ? ` ± ${error.toFixed(4)}` : ''), m.unit, m.name];
  });
  holder.replaceChildren(table(['Measure', network.confirmed ? 'By every ray' : 'From a sample', 'Unit', 'In front.json'], rows, [2, 3]));
}

function parameterTable(holder, parameters) {
  const rows = [];
  const walk = (value, path) => {
    if (value !== null && typeof value === 'object' && !Array.isArray(value))
      Object.entries(value).forEach(([key, inner]) => walk(inner, path ? `${path}.${key}` : key));
    else rows.push([path, typeof value === 'string' ? value : JSON.stringify(value)]);
  };
  walk(parameters, '');
  holder.append(table(['Parameter', 'Value'], rows, [1]));
}

// The card beside the view: one station, or the controls.
function stationCard(holder, network, k, only, { pick, stand }) {
  if (k === null) {
    holder.replaceChildren(element('h3', {}, 'Stations'), element('p', { class: 'muted' },
      'Pick a station, by its name in the view or in the table, for its links, what it alone sees'
        + (stand ? ' and the view from there.' : ', to lock it or to take it away.')));
    return;
  }
  const s = network.stations[k], parts = [element('h3', {}, s.name)];
  if (s.picture)
    parts.push(element('img', { class: 'sight', src: `data:image/jpeg;base64,${s.picture}`, alt: `What ${s.name} sees all around, towards the middle of the site in the middle` }));
  const facts = element('dl', {});
  const fact = (name, text) => facts.append(element('dt', {}, name), element('dd', {}, text));
  if (s.position) {
    fact('Head', s.position.map(metres).join(', ') + ' m');
    fact('Ground', `${metres(s.ground[2])} m, ${(s.position[2] - s.ground[2]).toFixed(2)} m below`);
  }
  if (s.points_on_surveyed !== null) fact('Points', `${grouped(s.points_on_surveyed)} on the site`);
  if (only !== null) fact('Only it sees', percent(only) + ' of the site');
  const stop = stopOf(network, k);
  if (stop) fact('Stop', `${stop.stop} of ${stop.of}${stop.session ? ` of ${stop.session[0].toLowerCase() + stop.session.slice(1)}` : ''}, after ${stop.walk} m on foot`);
  if (s.existing) fact('', 'was there before');
  if (s.fault) fact('Mind', s.fault);
  parts.push(facts);
  const links = (network.links || []).filter((l) => l.a === k || l.b === k).sort((l, r) => r.value - l.value);
  if (network.links) {
    parts.push(element('strong', {}, links.length ? 'Linked to' : 'Linked to no other station'));
    const kNamed = 8;
    parts.push(element('ul', {}, ...links.slice(0, kNamed).map((l) => element('li', {},
      `${network.stations[l.a === k ? l.b : l.a].name}, ${percent(l.value)}${l.bridge ? ', a bridge' : ''}${weak(network, l) ? ', weak' : ''}`)),
      s.linked > kNamed ? element('li', {}, `and ${s.linked - kNamed} more`) : null));
  }
  if (s.position && stand) {
    const look = element('button', { type: 'button', id: 'stand' }, 'Look round from here');
    look.addEventListener('click', () => stand(k));
    parts.push(look);
  }
  const clear = element('button', { type: 'button' }, 'Deselect');
  clear.addEventListener('click', () => pick(null));
  parts.push(clear);
  holder.replaceChildren(...parts);
}
