'use strict';
// Stations by hand: every change goes to the program, and the page shows its answers.

(async () => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const at = (id) => document.getElementById(id);
  const origin = data.view.origin, levels = data.view.levels;
  const waiting = [];
  let state = null, selected = null, sending = false, connected = true, drag = null;
  let mode = null;  // 'add' or 'measure': what a click in the view does
  let hiddenCells = null;

  at('title').textContent = data.title;
  const view = new SiteView(at('canvas'), data.view, pick);
  await view.load();
  const ground = await groundOf(data.view.ground);
  view.scene.add(ground);

  // Ground where stations may stand, laid over the floors.
  async function groundOf(packed) {
    const geometry = new THREE.BufferGeometry();
    const positions = new Float32Array((await unpack(packed.positions)).buffer);
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(fromPlanes(await unpack(packed.indices), packed.corners, 4), 1));
    const material = new THREE.ShaderMaterial({
      vertexShader: edgeVertexShader, uniforms: view.uniforms, transparent: true, depthWrite: false, side: THREE.DoubleSide,
      fragmentShader: edgeFragmentShader.replace('vec4(0.08, 0.10, 0.14, 0.35)', 'vec4(0.05, 0.48, 0.36, 0.45)'),
    });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.visible = false;
    return mesh;
  }
  function showGround() {
    ground.visible = at('show-ground').checked || mode === 'add' || drag !== null;
    view.draw();
  }

  // One request at a time; of a drag's positions that arrive meanwhile only the last is kept.
  async function send(change) {
    if (sending) {
      const last = waiting[waiting.length - 1];
      if (last && change.begin === false && last.do === 'move' && last.id === change.id) waiting.pop(), change.begin = last.begin;
      waiting.push(change);
      return;
    }
    sending = true;
    try {
      const response = await fetch('change', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(change) });
      const answer = await response.json();
      online();
      if (!response.ok) throw new Error(answer.error);
      await show(answer);
      if (answer.refused) tell(capital(answer.refused), true);
      view.labels.forEach((label, k) => label.classList.toggle('refused', Boolean(answer.refused) && state.ids[k] === change.id));
    } catch (error) {
      offline();
    }
    sending = false;
    if (waiting.length) await send(waiting.shift());
  }
  const capital = (text) => text && text[0].toUpperCase() + text.slice(1);
  function tell(text, bad = false) {
    at('status').textContent = text;
    at('status').classList.toggle('bad', bad);
  }
  function offline() {
    connected = false;
    tell('The program does not answer. All changes are in its folder: start it again with the same command.', true);
  }
  function online() {
    if (!connected) tell('');
    connected = true;
  }
  async function poll() {
    try {
      if (!sending && !drag) {
        const response = await fetch(`state?version=${state.version}`);
        online();
        if (response.status === 200) await show(await response.json());
      }
    } catch (error) {
      offline();
    }
    setTimeout(poll, state.busy ? 300 : 1000);
  }

  async function show(next) {
    if (state && next.version < state.version) return;
    const before = state, network = next.network;
    const [coverage, only] = await Promise.all([unpack(next.coverage), unpack(next.only)]);
    if (next.hidden !== hiddenCells) {
      hiddenCells = next.hidden;
      view.table.set(1, hiddenCells ? await unpack(hiddenCells) : null, 255);
    }
    const keep = before && selected !== null ? before.ids[selected] : null;
    const focused = view.labels.indexOf(document.activeElement);
    const taken = (of) => of.network.stations.map((station) => station.existing).join();
    const same = before && before.ids.join() === next.ids.join() && taken(before) === taken(next);
    state = next;
    selected = keep === null ? null : state.ids.indexOf(keep);
    if (selected === -1) selected = null;
    if (same) view.moveStations(network.stations, network.links || []);
    else view.setNetwork(network.stations, network.links || []);
    view.setColours(coverage, only);
    view.select(selected);
    view.only = only;
    view.labels.forEach((label, k) => {
      label.textContent = network.stations[k].name;
      label.classList.toggle('locked', state.locked[k]);
      label.setAttribute('aria-label', `${network.stations[k].name}${state.locked[k] ? ', locked' : ''}`);
      label.onpointerdown = (event) => grab(event, k);
      label.onkeydown = (event) => labelKey(event, k);
    });
    if (!same && focused >= 0 && view.labels.length) view.labels[Math.min(focused, view.labels.length - 1)].focus();
    figures(at('figures'), network);
    tellCaptured(network.values);
    const { registration } = network.values;
    if (registration && !state.exact && registration.standard_error > registration.value / 2)
      at('figures').querySelectorAll('div').forEach((tile) => {
        if (tile.querySelector('dt').textContent === 'Registered')
          tile.querySelector('small').textContent = `± ${tenths(registration.standard_error)} mm: the sample is too small to tell, “Every ray” does`;
      });
    if (!registration) at('figures').append(unknownTile('Registered', whyUnknown(network)));
    if (network.minutes_on_site === null && state.ids.length) at('figures').append(unknownTile('On site', whyUnknown(network)));
    words(at('words'), network, null);
    stationTable(at('stations'), network, pickInTable, [...network.stations.keys()]);  // rows that stay in their places
    linkTable(at('links'), at('links-words'), network);
    card();
    legend();
    at('undo').disabled = !state.undo || Boolean(state.busy);
    at('redo').disabled = !state.redo || Boolean(state.busy);
    at('exact').disabled = state.exact || !state.ids.length || Boolean(state.busy);
    at('improve').disabled = state.locked.every(Boolean) || Boolean(state.busy);
    at('add').disabled = Boolean(state.busy);
    at('save').textContent = state.busy ? 'Stop' : 'Save';
    if (state.busy) tell(`${capital(state.busy.what)}${state.busy.done > 0 ? `, ${Math.round(100 * state.busy.done)} %` : ' …'}`);
    else if (!mode || state.message) tell(capital(state.message));
    document.documentElement.dataset.version = state.version;
  }

  // The first tile says how well its figures are known.
  function tellCaptured({ coverage, capture }) {
    const sampled = (name, { value, standard_error: error }) => `${name} ${value.toFixed(4)}${state.exact ? '' : ` ± ${error.toFixed(4)}`}`;
    const share = capture && capture.value !== null ? `${capture.standard_error > 0 ? `± ${percent(capture.standard_error)} ` : ''}of what is attainable; ` : '';
    at('figures').querySelector('dd small').textContent = `${share}${sampled('coverage', coverage)}, ${state.exact ? 'by every ray' : 'from a sample'}`;
  }
  const unknownTile = (name, why) => element('div', {}, element('dt', {}, name), element('dd', {}, 'Not known', element('small', {}, why)));
  function whyUnknown(network) {
    if (network.stations.filter((s) => s.active).length < 2) return 'two stations are needed';
    return drag ? 'until the station is put down' : 'with so many stations after “Every ray” only';
  }

  function legend() {
    const item = (style, text, kind = '') => element('span', {}, element('i', { class: kind, style }), text);
    at('legend').replaceChildren(
      element('span', {}, 'no points', element('i', { class: 'ramp', style: `background:linear-gradient(90deg,${VIEW_COLOURS.ramp.join()})` }), 'wanted density'),
      ...(hiddenCells ? [item('', 'no place to stand could help', 'hatch')] : []),
      ...(state.network.stations.some((station) => station.existing)
        ? [item(`background:${VIEW_COLOURS.station}`, 'planned station'), item(`background:${VIEW_COLOURS.existing}`, 'taken')] : []),
      item(`background:${VIEW_COLOURS.blocking}`, 'not surveyed'), item(`background:${VIEW_COLOURS.only}`, 'only the picked station sees'),
      item(`background:${VIEW_COLOURS.link}`, 'link', 'stroke'),
      item(`background:repeating-linear-gradient(90deg,${VIEW_COLOURS.bridge} 0 6px,transparent 6px 9px)`, 'bridge', 'stroke'));
  }

  function pick(k) {
    if (drag && drag.moved) return;
    pickedInTable = false;
    selected = k === selected ? null : k;
    view.select(selected);
    card();
  }
  // The table is made anew with every answer, which takes the focus from the button that was pressed.
  let pickedInTable = false;
  function pickInTable(k) {
    pick(k);
    pickedInTable = selected !== null;
  }
  function card() {
    if (at('station').contains(document.activeElement) && document.activeElement.tagName === 'INPUT') return;  // a name is being typed
    const share = selected === null ? null : view.only.reduce((n, v) => n + (v === selected + 1), 0) / view.only.length;
    stationCard(at('station'), state.network, selected, share, { pick, stand: null });
    if (selected === null) {
      if (!state.ids.length) at('station').append(element('p', {}, 'There is no station yet: add one, then click its position.'));
      return;
    }
    const id = state.ids[selected], locked = state.locked[selected];
    const button = (text, change) => {
      const node = element('button', { type: 'button' }, text);
      node.addEventListener('click', () => send(change));
      at('station').append(node);
      return node;
    };
    const rename = element('button', { type: 'button', id: 'rename' }, 'Rename');
    rename.addEventListener('click', () => askName(id));
    at('station').append(rename);
    if (state.network.stations[selected].existing) return;  // a scan that was taken stays
    button(locked ? 'Unlock' : 'Lock', { do: 'lock', id, locked: !locked });
    button('Remove', { do: 'remove', id }).disabled = locked;
  }

  // A field in place of the card's title; Enter and leaving it rename the station, Escape does not.
  function askName(id) {
    const title = at('station').querySelector('h3'), field = element('input', { type: 'text', maxlength: 60, 'aria-label': 'Name of the station', value: title.textContent });
    let done = false;
    const end = (keep) => {
      if (done) return;
      done = true;
      const name = field.value.trim();
      field.replaceWith(title);
      if (keep && name !== title.textContent) send({ do: 'rename', id, name });
    };
    field.addEventListener('keydown', (event) => {
      event.stopPropagation();
      if (event.key === 'Enter' || event.key === 'Escape') end(event.key === 'Enter');
    });
    field.addEventListener('blur', () => end(true));
    title.replaceWith(field);
    field.select();
    field.focus();
  }

  // The ray through a position on the screen.
  function ray(event) {
    const box = view.canvas.getBoundingClientRect(), caster = new THREE.Raycaster();
    caster.setFromCamera({ x: (2 * (event.clientX - box.left)) / box.width - 1, y: 1 - (2 * (event.clientY - box.top)) / box.height }, view.camera);
    return caster;
  }
  const inSurvey = (point) => point.toArray().map((v, k) => v + origin[k]);

  // A station is dragged over the plane of its own ground.
  function grab(event, k) {
    if (event.button !== 0 || state.busy || drag) return;  // one station at a time, even with several fingers
    const station = state.network.stations[k], label = view.labels[k];
    if (state.locked[k]) return;
    event.preventDefault();
    label.focus();
    label.setPointerCapture(event.pointerId);
    const height = view.local(station.ground).z, plane = new THREE.Plane(new THREE.Vector3(0, 0, 1), -height);
    const from = ray(event).ray.intersectPlane(plane, new THREE.Vector3());
    if (!from) return;
    drag = { id: state.ids[k], offset: view.local(station.ground).sub(from), moved: false };
    label.classList.add('held');
    view.controls.enabled = false;
    showGround();
    const to = (e) => {
      const point = ray(e).ray.intersectPlane(plane, new THREE.Vector3());
      return point && inSurvey(point.add(drag.offset));
    };
    const move = (e) => {
      const slack = event.pointerType === 'touch' ? 8 : 4;  // a finger trembles
      if (!drag.moved && Math.hypot(e.clientX - event.clientX, e.clientY - event.clientY) < slack) return;
      const place = to(e);
      if (!place) return;
      send({ do: 'move', id: drag.id, to: place, begin: !drag.moved, end: false });
      drag.moved = true;
      drag.last = place;
    };
    const drop = (e) => {
      label.onpointermove = label.onpointerup = label.onpointercancel = null;
      label.classList.remove('held');
      view.controls.enabled = true;
      if (drag.moved) send({ do: 'move', id: drag.id, to: to(e) || drag.last, begin: false, end: true });
      const moved = drag.moved;
      setTimeout(() => { drag = null; showGround(); }, moved ? 50 : 0);
    };
    label.onpointermove = move;
    label.onpointerup = drop;
    label.onpointercancel = drop;
  }
  function labelKey(event, k) {
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const id = state.ids[k];
    if (by) {
      const step = event.shiftKey ? 1 : 0.25, [x, y, z] = state.network.stations[k].ground;
      send({ do: 'move', id, to: [x + step * by[0], y + step * by[1], z] });
    } else if (event.key === 'Delete') send({ do: 'remove', id });
    else if (event.key === 'F2') {
      if (selected !== k) pick(k);
      askName(id);
    } else if (event.key === 'l' || event.key === 'L') send({ do: 'lock', id, locked: !state.locked[k] });
    else return;
    event.preventDefault();
  }

  // First visible surface below the pointer, or the ground of the search area.
  function surfaceAt(event) {
    const [low, high] = view.slice;
    const shown = ground.visible;
    ground.visible = true;  // rays pass what is not
    const hit = ray(event).intersectObjects([view.surface, ground]).find(({ point }) => point.z >= low && point.z <= high);
    ground.visible = shown;
    return hit && inSurvey(hit.point);
  }
  const coordinates = (point) => point.map((v) => v.toFixed(2)).join(', ');
  function setMode(next) {
    mode = next;
    at('add').setAttribute('aria-pressed', String(mode === 'add'));
    at('measure').setAttribute('aria-pressed', String(mode === 'measure'));
    at('canvas').classList.toggle('adding', mode !== null);
    ends = [];
    showEnds();
    if (mode === 'add') tell('Click the position of the station; Enter puts it in the middle of the view, Escape leaves it.');
    if (mode === 'measure') tell('Click two points to measure between them; Escape ends it.');
    showGround();
  }

  // A measured distance: its ends in the survey frame, a line between them.
  let ends = [];
  const tape = new THREE.Group();
  view.scene.add(tape);
  function showEnds() {
    tape.traverse((mark) => { if (mark.geometry) mark.geometry.dispose(); });
    tape.remove(...tape.children);
    const colour = { color: '#c2185b', depthTest: false, transparent: true };
    const points = ends.map((end) => view.local(end)), size = Math.min(Math.max(view.extent * 0.003, 0.03), 0.5);
    for (const point of points) {
      const mark = new THREE.Mesh(new THREE.SphereGeometry(size, 16, 12), new THREE.MeshBasicMaterial(colour));
      mark.position.copy(point);
      tape.add(mark);
    }
    if (points.length === 2) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(points.flatMap((p) => p.toArray())), 3));
      tape.add(new THREE.Line(geometry, new THREE.LineBasicMaterial(colour)));
    }
    tape.children.forEach((mark) => { mark.renderOrder = 2; });
    view.draw();
  }
  function measureTo(place) {
    ends = ends.length === 2 ? [place] : [...ends, place];
    showEnds();
    if (ends.length === 1) return tell(`From ${coordinates(place)}: click the other end.`);
    const [dx, dy, dz] = ends[1].map((v, k) => v - ends[0][k]), flat = Math.hypot(dx, dy);
    return tell(`${Math.hypot(flat, dz).toFixed(3)} m: ${flat.toFixed(3)} m on the plan, ${Math.abs(dz).toFixed(3)} m ${dz < 0 ? 'down' : 'up'}, from ${coordinates(ends[0])} to ${coordinates(ends[1])}.`);
  }

  // A click acts on the point below it in the view, which is empty where nothing is.
  function act(place) {
    if (mode === 'measure') {
      if (place) measureTo(place);
      else tell('There is nothing to measure to here.', true);
      return;
    }
    setMode(null);
    if (place) send({ do: 'add', to: place });
    else tell('There is no ground to stand on here.', true);
  }
  let pressed = null;
  view.canvas.addEventListener('pointerdown', (event) => { pressed = event.isPrimary ? [event.clientX, event.clientY] : null; });
  view.canvas.addEventListener('pointerup', (event) => {
    if (!mode || !pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 5) return;
    act(surfaceAt(event));
  });
  // Coordinates below the pointer, less often where a large site takes a while to ask; always those of the last place.
  let asked = 0, later = null;
  function follow(event) {
    clearTimeout(later);
    const now = performance.now();
    if (now < asked) {
      later = setTimeout(() => follow(event), asked - now);
      return;
    }
    const place = surfaceAt(event);
    asked = performance.now() + Math.min(500, Math.max(50, 4 * (performance.now() - now)));
    at('at').hidden = !place;
    if (place) at('at').textContent = `x ${place[0].toFixed(2)}  y ${place[1].toFixed(2)}  z ${place[2].toFixed(2)}`;
  }
  view.canvas.addEventListener('pointermove', (event) => { if (!event.buttons) follow(event); });
  view.canvas.addEventListener('pointerleave', () => {
    clearTimeout(later);
    at('at').hidden = true;
  });
  document.addEventListener('keydown', (event) => {
    const free = document.activeElement === document.body || at('stations').contains(document.activeElement);
    if (pickedInTable && selected !== null && free && !event.ctrlKey && !event.metaKey && !event.altKey) labelKey(event, selected);
    if (event.key === 'Escape' && mode) {
      setMode(null);
      tell('');
    }
    if (event.key === 'Enter' && mode && document.activeElement === view.canvas) act(inSurvey(view.controls.target));
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'z') {
      event.preventDefault();
      send({ do: event.shiftKey ? 'redo' : 'undo' });
    }
  });
  for (const what of ['add', 'measure'])
    at(what).addEventListener('click', () => {
      setMode(mode === what ? null : what);
      if (mode) view.canvas.focus({ preventScroll: true });
    });
  at('save').addEventListener('click', () => send({ do: state.busy ? 'stop' : 'save' }));
  for (const what of ['undo', 'redo', 'exact', 'improve']) at(what).addEventListener('click', () => send({ do: what }));
  at('show-ground').addEventListener('change', showGround);

  sliceTools(view, levels, origin[2], data.state.network.stations);
  at('oblique').addEventListener('click', () => view.oblique());
  at('above').addEventListener('click', () => view.above());
  await show(data.state);
  view.oblique();
  poll();
  document.documentElement.dataset.ready = 'true';
})();
