// Plays a scene in meshcat's viewer: time, cameras, signs that are as large from everywhere, keys.
"use strict";

function playScene(commands, arrays, scene) {
  const at = id => document.getElementById(id);
  const THREE = MeshCat.THREE, body = document.body, pane = at("pane");
  const RADIANS = Math.PI / 180;
  const world = ([x, y, z]) => new THREE.Vector3(x, z, -y);  // the viewer's y is up

  const viewer = window.viewer = new MeshCat.Viewer(pane);
  const resized = viewer.set_3d_pane_size.bind(viewer);
  viewer.set_3d_pane_size = () => { if (pane.clientWidth && pane.clientHeight) resized(pane.clientWidth, pane.clientHeight); };
  viewer.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  viewer.gui.domElement.remove();
  function numbers({at: begin, rows, columns, parts}) {  // as Recorder.kept() in scene/recorder.py wrote them
    const count = rows * columns, values = parts === 1 ? new Uint32Array(count) : new Float32Array(count);
    for (let column = 0; column < columns; column++)
      for (let row = 0, sum = 0; row < rows; row++) {
        const place = begin + column * rows + row;
        const folded = arrays[place] | arrays[place + count] << 8 | arrays[place + 2 * count] << 16 | arrays[place + 3 * count] << 24;
        sum += folded >>> 1 ^ -(folded & 1);
        values[row * columns + column] = sum / parts;
      }
    return values;
  }
  for (const command of commands) {
    for (const {data} of command.object?.geometries ?? [])
      for (const attribute of [...Object.values(data?.attributes ?? {}), data?.index])
        if (attribute) attribute.array = numbers(attribute.array);
    viewer.handle_command(command);
  }
  viewer.scene.traverse(object => {  // corners were shared to make the page small; each face has its own light
    if (!object.isMesh) return;
    object.geometry = object.geometry.toNonIndexed();
    object.geometry.computeVertexNormals();
  });
  const node = name => viewer.scene_tree.find(["meshcat", name]).object;

  // --- cameras ---
  const camera = viewer.camera, controls = viewer.controls, corners = scene.corners;
  controls.maxPolarAngle = (scene.camera[1] < 0 ? 1 : 0.5) * Math.PI;  // not below the ground unless asked for
  let following = null;  // the number of the UAV that the camera follows

  function axesOf(azimuth, elevation) {
    const a = azimuth * RADIANS, e = elevation * RADIANS;
    const right = [-Math.sin(a), Math.cos(a), 0], back = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
    const up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2], back[0] * right[1] - back[1] * right[0]];
    return [right, up, back];
  }
  const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const sum = (...terms) => [0, 1, 2].map(i => terms.reduce((total, [weight, vector]) => total + weight * vector[i], 0));

  function fit(azimuth, elevation) {  // as fitted() in scene/camera.py
    const axes = axesOf(azimuth, Math.min(elevation, 89.9));
    const tangent = Math.tan(camera.fov * RADIANS / 2) / scene.margin;
    const [across, upward, toward] = axes.map(axis => corners.map(corner => dot(corner, axis)));
    const middle = (Math.max(...toward) + Math.min(...toward)) / 2;
    let distance = (Math.max(...toward) - middle) / (1 - scene.closest);
    for (const [places, t] of [[across, camera.aspect * tangent], [upward, tangent]]) {
      const high = Math.max(...places.map((a, i) => a + t * (toward[i] - middle)));
      const low = Math.max(...places.map((a, i) => -a + t * (toward[i] - middle)));
      distance = Math.max(distance, (high + low) / (2 * t));
    }
    const place = [across, upward].map(places => middleOf(places.map((a, i) => [a, distance + middle - toward[i]])));
    const target = sum([place[0], axes[0]], [place[1], axes[1]], [middle, axes[2]]), eye = sum([1, target], [distance, axes[2]]);
    const floor = Math.min(...corners.map(corner => corner[2])) + distance / 100;
    const nearer = elevation > 0 ? Math.max(0, Math.min((floor - target[2]) / axes[2][2], distance / 2)) : 0;
    look(eye, sum([1, target], [nearer, axes[2]]));  // turned about a point above the ground, the eye stays above it
  }
  function middleOf(points) {  // across and depth of each: from where they reach equally far to both sides
    let low = Math.min(...points.map(p => p[0])), high = Math.max(...points.map(p => p[0]));
    for (let turn = 0; turn < 40; turn++) {
      const middle = (low + high) / 2, seen = points.map(([across, depth]) => (across - middle) / depth);
      if (Math.max(...seen) > -Math.min(...seen)) low = middle; else high = middle;
    }
    return (low + high) / 2;
  }
  function look(eye, target) {
    camera.position.copy(world(eye));
    controls.target.copy(world(target));
    const distance = camera.position.distanceTo(controls.target);
    camera.near = distance / 200;
    camera.far = 20 * distance + 4 * scene.reach;
    controls.update();
    viewer.set_dirty();
  }
  function use(name) {
    following = name === "chase" ? 0 : null;
    at("camera").value = name in scene.cameras || name === "chase" ? name : "given";
    if (following !== null) chase(); else fit(...(name === "given" ? scene.camera : scene.cameras[name]));
  }
  function chase() {
    const mover = scene.movers[following], [place, turn] = where(mover, now);
    const nose = new THREE.Vector3(1, 0, 0).applyQuaternion(turn), level = Math.hypot(nose.x, nose.y) || 1;
    const [behind, above] = scene.chase.map(times => times * scene.size);
    look([place.x - behind * nose.x / level, place.y - behind * nose.y / level, place.z + above], place.toArray());
  }
  controls.addEventListener("start", () => { following = null; });

  // --- time ---
  const moving = scene.duration > 0;
  const slower = matchMedia("(prefers-reduced-motion: reduce)").matches;
  let now = scene.at, playing = moving && !scene.paused && !slower, last = null;

  function where(mover, moment) {
    const times = mover.time;
    let high = times.findIndex(t => t >= moment);
    if (high < 0) high = times.length - 1;
    const low = Math.max(high - 1, 0), span = times[high] - times[low];
    const share = span > 0 ? Math.min(Math.max((moment - times[low]) / span, 0), 1) : 1;
    const place = new THREE.Vector3(...mover.points[low]).lerp(new THREE.Vector3(...mover.points[high]), share);
    return [place, new THREE.Quaternion(...mover.turn[low]).slerp(new THREE.Quaternion(...mover.turn[high]), share)];
  }
  function words(moment) {
    if (scene.unit === "nodes") return `${Math.round(moment).toLocaleString("en")} of ${scene.duration.toLocaleString("en")} nodes`;
    return `${moment.toFixed(1)} of ${scene.duration.toFixed(1)} s`;
  }
  function seek(moment) {
    now = Math.min(Math.max(moment, 0), scene.duration);
    scene.movers.forEach((mover, number) => {
      const [place, turn] = where(mover, now), object = node(`mover${number}`);
      object.position.copy(place);
      object.quaternion.copy(turn);
    });
    for (const [name, since] of Object.entries(scene.since)) node(name).visible = since <= now;
    if (following !== null) chase();
    const scrub = at("scrub");
    if (moving) scrub.value = Math.round(1000 * now / scene.duration);
    scrub.setAttribute("aria-valuetext", words(now));
    at("clock").textContent = words(now);
    viewer.set_dirty();
  }
  function play(yes) {
    playing = yes && moving;
    if (playing && now >= scene.duration) seek(0);
    last = null;
    body.classList.toggle("playing", playing);
    at("play").setAttribute("aria-label", playing ? "Pause" : "Play");
  }
  function tick(moment) {
    requestAnimationFrame(tick);
    if (!playing) return;
    if (last !== null) {
      const ahead = now + Math.min(moment - last, 500) / 1000 * Number(at("speed").value);
      if (now >= scene.duration) { rest += moment - last; if (rest > 1500) { rest = 0; seek(0); } }
      else { rest = 0; seek(ahead); }
    }
    last = moment;
  }
  let rest = 0;  // how long it has stood at the end [ms]

  // --- signs ---
  const overlay = at("overlay"), SVG = "http://www.w3.org/2000/svg";
  const shapes = {start: "M-5 0a5 5 0 1 0 10 0a5 5 0 1 0-10 0", goal: "M0-7 7 6H-7z", stopped: "M-5-5H5V5H-5z",
                  missed: "M0-7 7 6H-7z", crash: "M-7-7 7 7M7-7-7 7", uav: "M-10 0a10 10 0 1 0 20 0a10 10 0 1 0-20 0"};
  function drawn(kind, color) {
    const group = document.createElementNS(SVG, "g"), hollow = ["missed", "crash", "uav"].includes(kind);
    for (const halo of [true, false]) {
      const path = group.appendChild(document.createElementNS(SVG, "path"));
      path.setAttribute("d", shapes[kind]);
      path.setAttribute("fill", hollow ? "none" : halo ? "#fff" : color);
      path.setAttribute("stroke", halo ? "#fff" : hollow ? color : "none");
      path.setAttribute("stroke-width", (hollow ? kind === "crash" ? 4 : 2 : 0) + (halo ? 3 : 0));
    }
    group.dataset.kind = kind;
    return overlay.appendChild(group);
  }
  const rings = (scene.rings ? scene.movers : []).map(mover => ({mover, element: drawn("uav", mover.color)}));
  const signs = scene.markers.map(marker => ({...marker, element: drawn(marker.kind, marker.color)}));

  function put(element, place, there) {
    const point = world(place).project(camera);
    const seen = there && Math.abs(point.z) <= 1;
    element.style.display = seen ? "" : "none";
    if (seen) element.setAttribute("transform", `translate(${((point.x + 1) / 2 * pane.clientWidth).toFixed(1)} ${((1 - point.y) / 2 * pane.clientHeight).toFixed(1)})`);
  }
  const after = [];  // what else is to be put in its place after each frame
  function update() {
    for (const act of after) act();
    for (const sign of signs) put(sign.element, sign.place, sign.since <= now + 1e-9);
    for (const ring of rings) {
      const place = where(ring.mover, now)[0].toArray();
      const pixels = scene.uav / world(place).distanceTo(camera.position) * pane.clientHeight / (2 * Math.tan(camera.fov * RADIANS / 2));
      put(ring.element, place, pixels < 30);
    }
    const back = camera.position.clone().sub(controls.target), azimuth = Math.atan2(back.x, back.z);
    const flat = Math.max(back.y / back.length(), 0.35);
    at("needle").setAttribute("transform", `scale(1 ${flat}) rotate(${azimuth / RADIANS})`);
    const ahead = [Math.sin(azimuth), -flat * Math.cos(azimuth)], stretch = 34 / Math.hypot(...ahead);
    ahead.forEach((part, i) => at("north").setAttribute("xy"[i], (stretch * part).toFixed(1)));
    at("windmark").style.display = scene.wind ? "inline" : "none";
    if (scene.wind) {
      const to = Math.atan2(scene.wind[0], scene.wind[1]);
      at("windmark").setAttribute("transform", `scale(1 ${flat}) rotate(${(azimuth + to) / RADIANS + 180}) scale(.8)`);
    }
    const metre = pane.clientHeight / (2 * Math.tan(camera.fov * RADIANS / 2) * back.length());  // in pixels, at the target
    const most = Math.min(150, 0.4 * pane.clientWidth) / metre, power = 10 ** Math.floor(Math.log10(most));
    const length = power * (most / power >= 5 ? 5 : most / power >= 2 ? 2 : 1);
    at("scale").style.width = `${length * metre}px`;
    at("scale").firstElementChild.textContent = length >= 1000 ? `${length / 1000} km` : `${length} m`;
  }
  const render = viewer.render.bind(viewer);
  viewer.render = () => {
    const near = camera.position.distanceTo(controls.target) < scene.closeup;
    for (const name of scene.near) node(name).visible = near;
    for (const name of scene.far) node(name).visible = !near;
    render();
    update();
  };

  // --- controls ---
  const names = [...Object.keys(scene.cameras), ...(scene.movers.length ? ["chase"] : [])];
  for (const name of [...names, ...(Array.isArray(scene.camera) ? ["given"] : [])]) at("camera").add(new Option(name, name));
  const pace = scene.duration / 12, real = scene.unit === "s";
  const paces = real ? [0.25, 0.5, 1, 2, 4, 8, 16, 32, 64].filter(p => p <= 1 || p < 8 * pace) : [0.25, 0.5, 1, 2, 4];
  for (const p of paces) at("speed").add(new Option(`${p} ×`, real ? p : p * pace));
  const nearest = real ? paces.reduce((a, b) => Math.abs(Math.log(b / pace)) < Math.abs(Math.log(a / pace)) ? b : a) : pace;
  at("speed").value = String(nearest);
  if (real) at("speed").title = "Speed, over real time";
  at("play").onclick = () => play(!playing);
  at("restart").onclick = () => seek(0);
  at("scrub").oninput = event => { play(false); seek(event.target.value / 1000 * scene.duration); };
  at("camera").onchange = event => use(event.target.value);
  at("full").onclick = () => document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen();
  at("full").hidden = !document.fullscreenEnabled;
  addEventListener("keydown", event => {
    if (event.target.matches("select") || event.ctrlKey || event.metaKey || event.altKey) return;
    const turn = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (event.key === " " && !event.target.matches("button,summary")) play(!playing);
    else if (event.key === "Home") seek(0);
    else if (event.key >= "1" && event.key <= String(names.length)) use(names[event.key - 1]);
    else if (event.key === "f" && !at("full").hidden) at("full").click();
    else if (event.key === "l") at("legend").open = !at("legend").open;
    else if (turn && event.target === pane) orbit(...turn);
    else if (["+", "-"].includes(event.key)) zoom(event.key === "+" ? 0.85 : 1 / 0.85);
    else if (turn && turn[0] && event.target !== at("scrub")) { play(false); seek(now + turn[0] * scene.duration / 50); }
    else return;
    event.preventDefault();
  });
  function orbit(sideways, upward) {
    following = null;
    const spot = new THREE.Spherical().setFromVector3(camera.position.clone().sub(controls.target));
    spot.theta += sideways * 10 * RADIANS;
    spot.phi = Math.min(Math.max(spot.phi - upward * 10 * RADIANS, 0.002), controls.maxPolarAngle);
    camera.position.setFromSpherical(spot).add(controls.target);
    viewer.set_dirty();
  }
  function zoom(times) {
    camera.position.sub(controls.target).multiplyScalar(times).add(controls.target);
    viewer.set_dirty();
  }

  body.classList.toggle("moving", moving);
  if (matchMedia("(max-width: 640px)").matches) at("legend").open = false;
  let fitted = true;
  controls.addEventListener("start", () => { fitted = false; });
  pane.addEventListener("wheel", () => { fitted = false; }, {passive: true});
  new ResizeObserver(() => {
    viewer.set_3d_pane_size();
    if (fitted && following === null) use(at("camera").value);
  }).observe(pane);
  viewer.set_3d_pane_size();
  use(Array.isArray(scene.camera) ? "given" : scene.camera);
  seek(now);
  play(playing);
  viewer.render();
  at("still").remove();
  requestAnimationFrame(tick);
  body.dataset.ready = "yes";
  function withoutRoutes() {  // for a page that draws its own
    for (const sign of signs.splice(0)) sign.element.remove();
    for (const name of scene.routes) {
      node(name).visible = false;
      for (const list of [scene.near, scene.far]) if (list.includes(name)) list.splice(list.indexOf(name), 1);
    }
  }
  return {THREE, viewer, camera, controls, world, pane, overlay, drawn, put, scene, after, withoutRoutes};
}
