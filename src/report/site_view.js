'use strict';
// The site in three dimensions: its surfaces in false colours, stations and links. Local frame, Z up, metres.

const VIEW_COLOURS = {
  // From no point to the goal density: orange through pale to blue, distinct for people with any kind of colour
  // blindness.
  ramp: ['#d8570b', '#f2a65a', '#f4ead2', '#8fbfdd', '#2c7bb6'],
  unseen: '#4a4453',  // with stripes
  blocking: '#d6d3cd',
  only: '#f5c400',
  reasons: Array(6).fill('#d6d3cd'),  // by WhyMissed; a report brings its own
  link: '#1d4f91',
  bridge: '#8c2d91',
  route: '#e07b00',
  station: '#1d4f91',
  existing: '#6b2a70',
  target: ['#1a1a1f', '#ffffff'],
};

const vertexShader = `
  attribute float kind;
  varying vec3 vAt;
  varying float vKind;
  void main() {
    vec4 at = modelMatrix * vec4(position, 1.0);
    vAt = at.xyz;
    vKind = kind;
    gl_Position = projectionMatrix * viewMatrix * at;
  }`;

// A cell's colours stand in a hash table of two textures, probed as in CellTable.
const fragmentShader = `
  precision highp int;
  uniform sampler2D keys, values;
  uniform vec3 corner;
  uniform float side, low, high;
  uniform int shift, only, mode;
  uniform vec3 ramp[5], reasons[6];
  uniform vec3 unseen, blocking, onlyColour, eye;
  varying vec3 vAt;
  varying float vKind;

  ivec2 texel(uint slot) { return ivec2(int(slot & 511u), int(slot >> 9)); }

  bool find(vec3 at, out uvec4 value) {
    vec3 cell = floor((at - corner) / side);
    if (any(lessThan(cell, vec3(0.0))) || any(greaterThan(cell, vec3(2047.0, 2047.0, 1022.0)))) return false;
    uvec3 c = uvec3(cell);
    uint key = c.x | c.y << 11 | c.z << 22;
    uint slots = 1u << uint(32 - shift);
    uint slot = (key * 2654435769u) >> uint(shift);
    for (int probe = 0; probe < 32; ++probe) {
      uvec4 t = uvec4(texelFetch(keys, texel(slot), 0) * 255.0 + 0.5);
      uint found = t.x | t.y << 8 | t.z << 16 | t.w << 24;
      if (found == key) {
        value = uvec4(texelFetch(values, texel(slot), 0) * 255.0 + 0.5);
        return true;
      }
      if (found == 0xffffffffu) return false;
      slot = (slot + 1u) & (slots - 1u);
    }
    return false;
  }

  vec3 along(float share) {
    float at = clamp(share, 0.0, 1.0) * 4.0;
    vec3 colour = ramp[0];
    for (int k = 0; k < 4; ++k) colour = mix(colour, ramp[k + 1], clamp(at - float(k), 0.0, 1.0));
    return colour;
  }

  void main() {
    if (vAt.z < low || vAt.z > high) discard;
    vec3 normal = normalize(cross(dFdx(vAt), dFdy(vAt)));
    vec3 colour = blocking;
    bool surveyed = mod(vKind + 0.5, 2.0) > 1.0, solid = vKind > 1.5;
    if (solid && !gl_FrontFacing) {  // cut open: the inside of a solid
      gl_FragColor = vec4(0.30, 0.32, 0.36, 1.0);
      return;
    }
    uvec4 value;
    if (surveyed && mode != 2 &&
        (find(vAt, value) || find(vAt + 0.4 * side * normal, value) || find(vAt - 0.4 * side * normal, value))) {
      bool striped = value.g >= 1u && value.g <= 4u && value.r < 13u;  // no point, and no allowed position could help
      if (mode == 1 && value.g < 6u) {
        for (int k = 0; k < 6; ++k) if (int(value.g) == k) colour = reasons[k];
        striped = false;
      } else {
        colour = along(float(value.r) / 254.0);
      }
      if (striped) colour = mod(gl_FragCoord.x + gl_FragCoord.y, 9.0) < 3.0 ? unseen + 0.22 : unseen;
      if (only > 0) colour = int(value.b) == only ? onlyColour : mix(colour, vec3(0.93), 0.72);
    } else if (surveyed) {
      colour = vec3(0.90, 0.87, 0.80);
    }
    vec3 towards = normalize(eye - vAt);
    if (dot(normal, towards) < 0.0) normal = -normal;
    float light = 0.70 + 0.18 * dot(normal, normalize(vec3(-0.4, -0.6, 0.9))) + 0.16 * abs(dot(normal, towards));
    gl_FragColor = vec4(colour * light, 1.0);
  }`;

const edgeVertexShader = `
  uniform vec3 eye;
  varying float vHeight;
  void main() {
    vHeight = position.z;
    vec3 before = mix(position, eye, 0.0015);  // the surfaces that meet there
    gl_Position = projectionMatrix * viewMatrix * vec4(before, 1.0);
  }`;

const edgeFragmentShader = `
  uniform float low, high;
  varying float vHeight;
  void main() {
    if (vHeight < low || vHeight > high) discard;
    gl_FragColor = vec4(0.08, 0.10, 0.14, 0.35);
  }`;

// Keys to slots by multiplication (Knuth), linear probing, at most half full.
class CellTable {
  constructor(keys) {
    let bits = 11;
    while (1 << bits < 2 * keys.length) ++bits;
    this.shift = 32 - bits;
    this.rows = 1 << (bits - 9);
    const slots = 1 << bits;
    const held = new Uint32Array(slots).fill(0xffffffff);
    this.slot = new Uint32Array(keys.length);
    keys.forEach((key, k) => {
      let slot = Math.imul(key, 2654435769) >>> this.shift;
      while (held[slot] !== 0xffffffff) slot = (slot + 1) & (slots - 1);
      held[slot] = key;
      this.slot[k] = slot;
    });
    this.keys = this.texture(new Uint8Array(held.buffer));
    this.bytes = new Uint8Array(4 * slots);
    this.values = this.texture(this.bytes);
  }

  texture(bytes) {
    const texture = new THREE.DataTexture(bytes, 512, this.rows, THREE.RGBAFormat, THREE.UnsignedByteType);
    texture.magFilter = texture.minFilter = THREE.NearestFilter;
    texture.needsUpdate = true;
    return texture;
  }

  // A byte for each cell; `channel` 0: coverage, 1: reason, 2: the only station.
  set(channel, bytes, otherwise) {
    this.slot.forEach((slot, k) => { this.bytes[4 * slot + channel] = bytes ? bytes[k] : otherwise; });
    this.values.needsUpdate = true;
  }
}

function svgNode(name, attributes) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  return node;
}

class SiteView {
  // `view`: from the report's data. Calls onPick(k) when a station is picked by its label. `crs`: the coordinate system
  // whose north is shown; empty: the axes are.
  constructor(holder, view, onPick, crs = '') {
    this.holder = holder;
    this.view = view;
    this.onPick = onPick;
    this.canvas = document.createElement('canvas');
    const context = this.canvas.getContext('webgl2', { antialias: true });
    if (!context) throw new Error('no WebGL 2');
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, context, antialias: true });
    this.renderer.setClearColor(0xffffff, 0);
    this.renderer.setClearAlpha(0);
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'application');
    this.canvas.setAttribute('aria-label', 'The site in three dimensions. Arrows turn, plus and minus come closer.');
    this.canvas.setAttribute('aria-describedby', 'view-help');
    this.printed = document.createElement('img');
    this.printed.alt = 'The site with its stations and links';
    this.scaleBar = Object.assign(document.createElement('div'), { className: 'view-scale' });
    this.size = Object.assign(document.createElement('div'), { className: 'view-size' });
    this.north = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    this.north.setAttribute('class', 'view-north');
    this.north.setAttribute('viewBox', '-26 -26 52 52');
    this.up = crs ? 'N' : 'y';
    holder.append(this.canvas, this.printed, this.scaleBar, this.size, this.north);

    const low = new THREE.Vector3(...view.mesh.low), high = new THREE.Vector3(...view.mesh.high);
    this.low = low;
    this.high = high;
    this.focus = [new THREE.Vector3(...view.mesh.surveyed_low), new THREE.Vector3(...view.mesh.surveyed_high)];
    this.extent = this.focus[1].distanceTo(this.focus[0]);
    this.centre = this.focus[0].clone().add(this.focus[1]).multiplyScalar(0.5);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(38, 1, this.extent / 2000, this.extent * 20);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.controls.addEventListener('change', () => this.draw());
    this.marks = new THREE.Group();
    this.scene.add(this.marks);
    const across = view.mesh.surveyed_high.map((v, k) => v - view.mesh.surveyed_low[k]);
    this.size.textContent = `${across[0].toFixed(1)} × ${across[1].toFixed(1)} m, ${across[2].toFixed(1)} m high`;
    this.labels = [];
    this.stations = [];
    this.targets = [];
    this.visit = null;
    this.links = [];
    this.selected = null;
    this.slice = [low.z, high.z];
    this.canvas.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.resize()).observe(holder);
  }

  async load() {
    const { positions, indices, kinds } = await unpackMesh(this.view.mesh);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute('kind', new THREE.BufferAttribute(kinds, 1));
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    const cells = this.view.cells;
    this.table = new CellTable(cells ? await unpackKeys(cells) : new Uint32Array(0));
    this.table.set(1, cells && cells.reasons ? await unpack(cells.reasons) : null, 255);
    const colours = (list) => list.map((c) => new THREE.Color(c));
    this.uniforms = {
      keys: { value: this.table.keys }, values: { value: this.table.values }, shift: { value: this.table.shift },
      corner: { value: new THREE.Vector3(...(cells ? cells.corner : [0, 0, 0])) }, side: { value: cells ? cells.size_m : 1 },
      low: { value: this.slice[0] }, high: { value: this.slice[1] }, only: { value: 0 }, mode: { value: cells ? 0 : 2 },
      ramp: { value: colours(VIEW_COLOURS.ramp) }, reasons: { value: colours(VIEW_COLOURS.reasons) },
      unseen: { value: new THREE.Color(VIEW_COLOURS.unseen) }, blocking: { value: new THREE.Color(VIEW_COLOURS.blocking) },
      onlyColour: { value: new THREE.Color(VIEW_COLOURS.only) }, eye: { value: this.camera.position },
    };
    const material = new THREE.ShaderMaterial({ vertexShader, fragmentShader, uniforms: this.uniforms, side: THREE.DoubleSide });
    this.surface = new THREE.Mesh(geometry, material);
    this.surface.position.copy(this.low);
    this.surface.scale.copy(this.high).sub(this.low).divideScalar(65535);
    this.surface.frustumCulled = false;
    this.scene.add(this.surface);
    this.addEdges(positions, indices);
    this.resize();
    this.oblique();
  }

  // Adds lines where surfaces meet at an angle, unless that takes long.
  addEdges(positions, indices) {
    if (indices.length > 3 * 80000) return;
    const geometry = new THREE.BufferGeometry();
    const scaled = new Float32Array(positions.length), low = this.low.toArray(), size = this.high.clone().sub(this.low).toArray();
    positions.forEach((v, k) => { scaled[k] = low[k % 3] + (v / 65535) * size[k % 3]; });
    geometry.setAttribute('position', new THREE.BufferAttribute(scaled, 3));
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    const material = new THREE.ShaderMaterial({ vertexShader: edgeVertexShader, fragmentShader: edgeFragmentShader, uniforms: this.uniforms, transparent: true });
    const edges = new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 30), material);
    edges.frustumCulled = false;
    this.scene.add(edges);
  }

  local(point) { return new THREE.Vector3(...point.map((v, k) => v - this.view.origin[k])); }

  // `stations` and `links` in the form of the report.
  setNetwork(stations, links, visit = null, targets = []) {
    this.stations = stations;
    this.targets = targets;
    this.visit = visit;
    // Of many links those that the survey depends on.
    const kMost = 4 * stations.length;
    this.links = links.length > kMost ? links.filter((link) => link.tree || link.bridge) : links;
    this.selected = null;
    this.labels.forEach((label) => label.remove());
    this.labels = stations.map((station, k) => {
      const label = document.createElement('button');
      label.type = 'button';
      label.className = 'label' + (station.existing ? ' existing' : '') + (station.active ? '' : ' left-out');
      label.textContent = station.name;
      label.setAttribute('aria-pressed', 'false');
      label.addEventListener('click', () => this.onPick(k));
      label.hidden = !station.position;
      this.holder.append(label);
      return label;
    }).concat(targets.map((target) => {
      const label = document.createElement('span');
      label.className = 'label target';
      label.textContent = target.name;
      this.holder.append(label);
      return label;
    }));
    this.drawMarks();
  }

  // Of the k-th label.
  placeOf(k) { return k < this.stations.length ? this.stations[k].position : this.targets[k - this.stations.length].position; }

  // The same stations at other positions.
  moveStations(stations, links) {
    this.stations = stations;
    this.links = links;
    stations.forEach((station, k) => {
      this.labels[k].classList.toggle('left-out', !station.active);
      this.labels[k].hidden = !station.position;
    });
    this.drawMarks();
  }

  drawMarks() {
    this.marks.traverse((mark) => { if (mark.geometry) mark.geometry.dispose(); });
    this.marks.remove(...this.marks.children);
    const size = Math.min(Math.max(this.extent * 0.005, 0.05), 1.5);
    const add = (geometry, colour, at, overall) => {
      const mark = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ color: colour, depthTest: !overall, transparent: Boolean(overall), opacity: overall ? 0.85 : 1 }));
      if (overall) mark.renderOrder = 1;
      mark.position.copy(at);
      this.marks.add(mark);
      return mark;
    };
    const rod = (a, b, radius, colour, overall) => {
      const along = b.clone().sub(a);
      const mark = add(new THREE.CylinderGeometry(radius, radius, along.length(), 8), colour, a.clone().add(b).multiplyScalar(0.5), overall);
      mark.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
    };
    this.stations.forEach((station, k) => {
      if (!station.position) return;
      const head = this.local(station.position), colour = k === this.selected ? '#111111' : station.existing ? VIEW_COLOURS.existing : VIEW_COLOURS.station;
      if (!this.shown(head)) return;
      add(new THREE.SphereGeometry(size, 20, 14), colour, head);
      rod(this.local(station.ground), head, size * 0.18, colour);
    });
    for (const target of this.targets) {
      const at = this.local(target.position);
      if (!this.shown(at)) continue;
      for (let k = 0; k < 4; ++k)  // checkered all around
        add(new THREE.SphereGeometry(0.8 * size, 6, 12, (k * Math.PI) / 2, Math.PI / 2), VIEW_COLOURS.target[k % 2], at);
    }
    if (this.visit) this.addRoute(size);
    const most = Math.max(0.5, ...this.links.map((link) => link.value));
    for (const link of this.links) {
      const a = this.local(this.stations[link.a].position), b = this.local(this.stations[link.b].position);
      if (!this.shown(a) || !this.shown(b)) continue;
      const faint = this.selected !== null && link.a !== this.selected && link.b !== this.selected;
      if (faint) continue;
      const radius = size * (0.06 + 0.3 * link.value / most);
      if (!link.bridge) {
        rod(a, b, radius, VIEW_COLOURS.link, true);
        continue;
      }
      const dashes = Math.max(3, Math.round(a.distanceTo(b) / (4 * size)));
      for (let d = 0; d < dashes; ++d)
        rod(a.clone().lerp(b, d / dashes), a.clone().lerp(b, (d + 0.6) / dashes), radius, VIEW_COLOURS.bridge, true);
    }
    this.draw();
  }

  // The way of the round as a band on the ground.
  addRoute(size) {
    const corners = [], width = 0.35 * size;
    for (const way of [this.visit, ...(this.visit.sessions || [])].flatMap((round) => round.ways))
      for (let k = 0; k + 5 < way.length; k += 3) {
        const a = this.local(way.slice(k, k + 3)), b = this.local(way.slice(k + 3, k + 6));
        if (!this.shown(a) || !this.shown(b)) continue;
        const side = new THREE.Vector3(a.y - b.y, b.x - a.x, 0);
        if (side.lengthSq() === 0) continue;
        side.setLength(width);
        const [p, q, r, t] = [a.clone().add(side), a.clone().sub(side), b.clone().sub(side), b.clone().add(side)];
        for (const v of [p, q, r, p, r, t]) corners.push(v.x, v.y, v.z + 0.05);
      }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(corners), 3));
    const band = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ color: VIEW_COLOURS.route, side: THREE.DoubleSide, depthTest: false, transparent: true, opacity: 0.8 }));
    band.renderOrder = 1;
    band.frustumCulled = false;
    this.marks.add(band);
  }

  shown(at) { return at.z >= this.slice[0] - 0.5 && at.z <= this.slice[1] + 0.5; }

  // A byte for each cell; null: unknown.
  setColours(coverage, only) {
    this.known = Boolean(coverage);
    this.table.set(0, coverage, 255);
    this.table.set(2, only, 0);
    this.setMode(this.wanted || 'coverage');
  }

  setMode(mode) {
    this.wanted = mode;
    this.uniforms.mode.value = mode === 'why' ? 1 : mode === 'coverage' && this.known ? 0 : 2;
    this.draw();
  }

  // Range of local heights in which surfaces are shown.
  setSlice(low, high) {
    this.slice = [low, high];
    this.uniforms.low.value = low;
    this.uniforms.high.value = high;
    this.drawMarks();
  }

  select(k) {
    this.selected = k;
    this.uniforms.only.value = k === null || !this.known ? 0 : k + 1;
    this.labels.forEach((label, i) => label.setAttribute('aria-pressed', String(i === k)));
    this.drawMarks();
  }

  // Extent for the camera: surveyed surfaces and stations within the slice.
  frame(direction) {
    this.leave();
    const [low, high] = this.focus.map((corner) => corner.clone().setZ(Math.min(Math.max(corner.z, this.slice[0]), this.slice[1])));
    for (const station of this.stations)
      for (const point of [station.position, station.ground])
        if (point && this.shown(this.local(station.position))) {
          low.min(this.local(point));
          high.max(this.local(point));
        }
    const target = low.clone().add(high).multiplyScalar(0.5);
    const towards = direction.clone().normalize();
    const up = Math.tan(THREE.Math.degToRad(this.camera.fov / 2)), across = up * this.camera.aspect;
    let distance = 0;
    // As near as all corners allow, then centre the visible part; this converges in a few rounds.
    for (let round = 0; round < 6; ++round) {
      this.camera.position.copy(target).add(towards);
      this.camera.lookAt(target);
      this.camera.updateMatrixWorld();
      const inverse = new THREE.Matrix4().getInverse(this.camera.matrixWorld), corners = [];
      for (let corner = 0; corner < 8; ++corner)
        corners.push(new THREE.Vector3(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z).applyMatrix4(inverse));
      distance = Math.max(...corners.map((at) => 1 + at.z + Math.max(Math.abs(at.x) / across, Math.abs(at.y) / up)));
      const middle = (axis) => {
        const places = corners.map((at) => at[axis] / (distance - 1 - at.z));
        return (distance * (Math.min(...places) + Math.max(...places))) / 2;
      };
      const right = new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0), top = new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
      target.addScaledVector(right, middle('x')).addScaledVector(top, middle('y'));
    }
    this.camera.position.copy(target).addScaledVector(towards, 1.06 * distance);
    this.controls.target.copy(target);
    this.controls.update();
    this.draw();
  }
  oblique() { this.frame(new THREE.Vector3(-0.45, -0.75, 0.8)); }
  above() { this.frame(new THREE.Vector3(0, -0.001, 1)); }

  // Looks round from a station's head, at the whole site.
  stand(k) {
    const head = this.local(this.stations[k].position), outward = this.centre.clone().sub(head).setZ(0);
    if (outward.length() < 0.1) outward.set(1, 0, 0);
    this.standing = { slice: this.slice };
    this.camera.fov = 75;
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(head);
    this.controls.target.copy(head).addScaledVector(outward.normalize(), 0.02);
    this.controls.enableZoom = this.controls.enablePan = false;
    this.controls.rotateSpeed = -0.4;
    this.marks.visible = false;
    this.setSlice(this.low.z, this.high.z);
    this.controls.update();
    this.draw();
  }
  leave() {
    if (!this.standing) return;
    const { slice } = this.standing;
    this.standing = null;
    this.camera.fov = 38;
    this.camera.updateProjectionMatrix();
    this.controls.enableZoom = this.controls.enablePan = true;
    this.controls.rotateSpeed = 1;
    this.marks.visible = true;
    this.setSlice(...slice);
    this.oblique();
  }

  key(event) {
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const offset = this.camera.position.clone().sub(this.controls.target);
    if (turn) {
      const step = 0.12 * (this.standing ? -1 : 1), length = offset.length();
      const azimuth = Math.atan2(offset.y, offset.x) + step * turn[0];
      const polar = Math.min(Math.max(Math.acos(offset.z / length) + step * turn[1], 0.01), Math.PI - 0.01);
      offset.set(Math.sin(polar) * Math.cos(azimuth), Math.sin(polar) * Math.sin(azimuth), Math.cos(polar)).multiplyScalar(length);
    } else if (event.key === '+' || event.key === '=' || event.key === '-') {
      if (this.standing) return;
      offset.multiplyScalar(event.key === '-' ? 1.15 : 1 / 1.15);
    } else if (event.key === 'Home') {
      event.preventDefault();
      return this.oblique();
    } else {
      return;
    }
    event.preventDefault();
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  resize() {
    const width = this.holder.clientWidth, height = this.holder.clientHeight;
    if (!width || !height || (width === this.width && height === this.height)) return;
    this.width = width;
    this.height = height;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    if (this.waiting || !this.surface) return;
    this.waiting = true;
    requestAnimationFrame(() => this.drawNow());
  }
  drawNow() {
    this.waiting = false;
    if (!this.width) return;
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = this.standing ? 0.03 : Math.max(0.03 * distance, this.extent / 5000);
    this.camera.far = distance + 2 * this.high.distanceTo(this.low);
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    this.placeLabels();
    this.placeScale(distance);
  }

  // Names of stations over their heads. One that would lie on another, or is of another storey, is a dot.
  placeLabels() {
    const taken = new Map(), kCell = 48, kGap = 1, kHeight = 24, kOver = 7;
    const near = (box) => {
      const keys = [];
      for (let i = Math.floor(box[0] / kCell); i <= Math.floor(box[2] / kCell); ++i)
        for (let j = Math.floor(box[1] / kCell); j <= Math.floor(box[3] / kCell); ++j) keys.push(`${i} ${j}`);
      return keys;
    };
    const places = this.labels.map((label, k) => {
      const place = this.placeOf(k);
      if (!place) return null;
      const head = this.local(place), at = head.clone().project(this.camera);
      label.hidden = at.z > 1 || Math.abs(at.x) > 1.05 || Math.abs(at.y) > 1.05 || Boolean(this.standing);
      return label.hidden ? null : { k, label, off: !this.shown(head), z: at.z, x: ((at.x + 1) / 2) * this.width, y: ((1 - at.y) / 2) * this.height };
    }).filter((place) => place);
    // The picked one first, then what is shown and near.
    places.sort((a, b) => Number(b.k === this.selected) - Number(a.k === this.selected) || Number(a.off) - Number(b.off) || a.z - b.z);
    for (const { k, label, off, x, y } of places) {
      const half = 4 * label.textContent.length + 8;
      const box = [x - half - kGap, y - kOver - kHeight - kGap, x + half + kGap, y - kOver + kGap], keys = near(box);
      const meets = (other) => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3];
      const crowded = k !== this.selected && (off || keys.some((key) => (taken.get(key) || []).some(meets)));
      label.classList.toggle('off', off);
      label.classList.toggle('crowded', crowded);
      if (!crowded) keys.forEach((key) => taken.set(key, [...(taken.get(key) || []), box]));
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, ${crowded ? '-50%' : `calc(-100% - ${kOver}px)`})`;
    }
  }

  // A bar of a round length, true at the middle of what is seen, and where north is, or the axes.
  placeScale(distance) {
    this.scaleBar.hidden = Boolean(this.standing);
    this.north.style.display = this.standing ? 'none' : '';
    const metre = this.height / (2 * distance * Math.tan(THREE.Math.degToRad(this.camera.fov / 2)));
    const wanted = 120 / metre, power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map((f) => f * power).find((l) => l <= wanted) || power;
    this.scaleBar.style.width = `${(length * metre).toFixed(1)}px`;
    this.scaleBar.textContent = `${length >= 1 ? length : length.toFixed(2)} m`;
    const arrow = (axis, name) => {
      const v = axis.transformDirection(this.camera.matrixWorldInverse);
      const line = svgNode('line', { x1: 0, y1: 0, x2: (14 * v.x).toFixed(1), y2: (-14 * v.y).toFixed(1), stroke: '#1b222c', 'stroke-width': 2 });
      const text = svgNode('text', { x: (20 * v.x).toFixed(1), y: (4 - 20 * v.y).toFixed(1), 'font-size': 10, 'font-weight': 600, 'text-anchor': 'middle', fill: '#1b222c' });
      text.textContent = name;
      const [dx, dy] = [v.x, -v.y], tip = [14 * dx, 14 * dy], wing = (side) => `${(tip[0] - 5 * dx - 3 * side * dy).toFixed(1)},${(tip[1] - 5 * dy + 3 * side * dx).toFixed(1)}`;
      const head = svgNode('polygon', { points: `${tip.map((c) => c.toFixed(1)).join()} ${wing(1)} ${wing(-1)}`, fill: '#1b222c' });
      return [line, head, text];
    };
    this.north.replaceChildren(...arrow(new THREE.Vector3(0, 1, 0), this.up), ...(this.up === 'y' ? arrow(new THREE.Vector3(1, 0, 0), 'x') : []));
  }

  // The screen's content with the stations' names, for paper.
  picture() {
    this.drawNow();
    const page = document.createElement('canvas'), scale = this.canvas.width / this.width;
    page.width = this.canvas.width;
    page.height = this.canvas.height;
    const pen = page.getContext('2d');
    pen.fillStyle = '#fff';
    pen.fillRect(0, 0, page.width, page.height);
    pen.drawImage(this.canvas, 0, 0);
    const frame = this.holder.getBoundingClientRect();
    pen.font = `600 ${13 * scale}px system-ui, sans-serif`;
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    for (const label of this.labels) {
      const box = label.getBoundingClientRect();
      if (label.hidden || !box.width) continue;
      if (label.classList.contains('crowded')) continue;
      pen.fillStyle = getComputedStyle(label).backgroundColor;
      pen.fillRect((box.left - frame.left) * scale, (box.top - frame.top) * scale, box.width * scale, box.height * scale);
      pen.fillStyle = '#fff';
      pen.fillText(label.textContent, (box.left + box.width / 2 - frame.left) * scale, (box.top + box.height / 2 - frame.top) * scale);
    }
    // The bar and its length.
    const bar = this.scaleBar.getBoundingClientRect(), left = (bar.left - frame.left) * scale, foot = (bar.bottom - frame.top) * scale;
    pen.fillStyle = '#1b222c';
    pen.fillRect(left, foot - 3 * scale, bar.width * scale, 3 * scale);
    pen.fillText(this.scaleBar.textContent, left + (bar.width * scale) / 2, foot - 12 * scale);
    this.printed.src = page.toDataURL('image/png');
  }
}

// The page's controls for the shown storey and the height of its cut. `origin`: the local frame's height. The storey
// with most stations is shown first.
function sliceTools(view, levels, origin, stations) {
  const [level, cut, height] = ['level', 'cut', 'cut-height'].map((id) => document.getElementById(id));
  document.getElementById('level-label').hidden = levels.length === 0;
  const option = (value, text) => level.append(Object.assign(document.createElement('option'), { value, textContent: text }));
  levels.forEach((l, k) => option(k, levels.length > 1 ? `${k + 1}, floor at ${l.floor.toFixed(2)} m` : 'without ceiling'));
  option(-1, 'whole site');
  level.value = levels.length === 0 ? -1 : 0;
  const standing = levels.map(() => 0);
  for (const { ground } of stations)
    if (ground && levels.length) ++standing[Math.max(0, levels.filter((l) => l.floor <= ground[2] + 0.6).length - 1)];
  if (levels.length) level.value = standing.indexOf(Math.max(...standing));
  const cutAt = (local) => {
    const low = view.low.z, high = view.high.z, chosen = levels[Number(level.value)];
    cut.value = Math.round((1000 * (local - low)) / (high - low));
    height.textContent = `${(local + origin).toFixed(2)} m`;
    view.setSlice(chosen ? chosen.low - origin : low - 1, local >= high ? high + 1 : local);
  };
  const choose = () => {
    const chosen = levels[Number(level.value)];
    cutAt(chosen ? chosen.high - origin : view.high.z);
    view.oblique();
  };
  const slide = () => cutAt(view.low.z + (cut.value / 1000) * (view.high.z - view.low.z));
  level.addEventListener('change', choose);
  cut.addEventListener('input', slide);
  view.canvas.addEventListener('keydown', (event) => {
    const step = { PageUp: 20, PageDown: -20 }[event.key];
    if (!step) return;
    event.preventDefault();
    cut.value = Number(cut.value) + step;
    slide();
  });
  choose();
}
