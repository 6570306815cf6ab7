// A scene that answers: ends to drag, sliders, and the library's own planners and flights, from planners.wasm.
"use strict";

function playLive(stage, planners, live, buffer) {
  const {THREE, viewer, camera, controls, world, pane, drawn, put} = stage;
  const at = id => document.getElementById(id);
  const [nx, ny, nz] = live.shape, count = nx * ny * nz, cell = live.cell;

  // --- the city, in the planners' memory ---
  const kept = name => live.arrays[name];
  function bits(name) {  // packed as numpy.packbits does
    const flags = new Uint8Array(count), begin = kept(name);
    if (begin !== undefined) for (let n = 0; n < count; n++) flags[n] = buffer[begin + (n >> 3)] >> 7 - (n & 7) & 1;
    return planners.numbers("boolean", flags, live.shape);
  }
  const floats = (name, length) => new Float64Array(buffer.slice(kept(name), kept(name) + 8 * length).buffer);
  const origin = planners.numbers("float64", live.origin);
  const occupied = bits("occupied"), closed = bits("closed"), clearance = planners.empty("float64", ...live.shape);
  planners.clear(occupied, cell, clearance);
  function runsOf(flags) {
    const first = planners.empty("int64", nx * ny + 1), number = planners.count_runs(flags, first);
    const runs = [first, planners.empty("int32", number), planners.empty("int32", number), planners.empty("boolean", number)];
    planners.put_runs(flags, ...runs);
    return runs;
  }
  const banned = bits("zones"), walls = runsOf(occupied), zones = runsOf(banned);
  const facts = planners.empty("float64", planners.answers.length), points = planners.empty("float64", live.room, 3), price = planners.empty("float64", ...live.shape);
  const nobody = planners.empty("int32", 0), order = live.expansions ? planners.empty("int32", count) : nobody;
  const fact = name => facts.values[planners.answers.indexOf(name)];
  const risk = live.risk && {
    rate: planners.numbers("float64", floats("rate", count), live.shape),
    climb: planners.numbers("boolean", Uint8Array.from(live.risk.climb)),
    turn: planners.numbers("boolean", Uint8Array.from(live.risk.turn.flat()), [live.risk.turn.length, 26]),
    low: bits("low"), barred: planners.empty("boolean", ...live.shape),
    prices: Object.fromEntries(live.risk.prices.map(name => [name, planners.numbers("float64", floats(name, count), [1, count])])),
  };
  if (risk) planners.close(occupied, banned, clearance, 0, cell, risk.barred);
  const shut = new Map();  // what is closed, by the clearance to keep
  function blockedAt(least) {
    if (!shut.has(least)) {
      if (shut.size > 3) { const [oldest] = shut.keys(); shut.get(oldest).free(); shut.delete(oldest); }
      const flags = planners.empty("boolean", ...live.shape);
      planners.close(occupied, closed, clearance, least, cell, flags);
      shut.set(least, flags);
    }
    return shut.get(least);
  }

  // --- state ---
  const state = {};
  function startOver() {
    state.ends = Object.fromEntries(live.ends);
    state.values = Object.fromEntries(live.sliders.map(({name, value}) => [name, value]));
    state.shown = new Set(live.offers.filter(offer => offer.shown).map(offer => offer.name));
  }
  startOver();
  const indexOf = place => place.map((x, a) => Math.min(Math.max(Math.floor((x - live.origin[a]) / cell), 0), live.shape[a] - 1));
  const snapped = place => live.curve ? place.map((x, a) => Math.round(10 * Math.min(Math.max(x, live.origin[a]), live.origin[a] + cell * live.shape[a])) / 10) : centreOf(indexOf(place));
  const codeOf = ([i, j, k]) => (i * ny + j) * nz + k;
  const centreOf = index => index.map((i, a) => live.origin[a] + cell * (i + 0.5));
  const pointOf = code => centreOf([Math.floor(code / (ny * nz)), Math.floor(code / nz) % ny, code % nz]);
  const shown = place => `(${place.map(x => String(Math.round(1000 * x) / 1000)).join(", ")})`;
  const python = place => `(${place.map(x => Number.isInteger(x) ? `${x}.0` : String(x)).join(", ")})`;
  const value = name => state.values[name];
  const conditions = () => live.conditions[value("conditions")];

  // --- what each planner does with the settings ---
  const SOLVERS = {
    astar: (offer, ends) => planners.astar(blockedAt(value("keep")), offer.heuristic, ...ends, origin, cell, points, order, facts),
    zone(offer, ends) {
      const cheapest = planners.price_zone(clearance, value("keep"), value("omega"), cell, price);
      return planners.astar_priced(blockedAt(0), price, cheapest, 1, ...ends, origin, cell, points, order, facts);
    },
    hazard(offer, ends) {
      planners.price_hazard(clearance, value("sigma"), offer.radius, offer.price, price);
      return straightened(planners.astar_priced(blockedAt(offer.radius), price, 1, 1, ...ends, origin, cell, points, order, facts), offer.radius);
    },
    repare(offer, ends) {
      const {distance, penalty, blown, loaded} = conditions();
      planners.price_repare(clearance, distance, penalty, blown, loaded, cell, price);
      return planners.astar_priced(blockedAt(offer.radius), price, 1, 1, ...ends, origin, cell, points, order, facts);
    },
    theta: (offer, ends) => planners.thetastar(blockedAt(value("keep")), value("keep"), live.slack, ...ends, origin, cell, ...walls, ...zones, points, facts),
    field(offer, ends, places) {
      const [from, to] = places.map(place => planners.numbers("float64", place));
      const found = planners.field(occupied, blockedAt(0), cell, origin, from, to, 0, offer.push, value("reach"), cell / 2, live.room - 1, points, facts);
      from.free();
      to.free();
      return found;
    },
    risk: (offer, ends) => planners.least_risk(blockedAt(0), risk.prices[offer.price], risk.climb, risk.turn, ...ends, origin, cell, points, facts),
  };
  function straightened(found, least) {
    return found && planners.straighten(points, found, price, least, live.slack, origin, cell, ...walls, ...zones, facts);
  }
  const timed = new Set();
  const keptBy = offer => ({astar: value("keep"), theta: value("keep"), hazard: offer.radius, repare: conditions()?.distance})[offer.kind] ?? 0;

  const isLow = code => risk.low.values[code] && !risk.barred.values[code];
  function airborne(code) {  // where a planner by risk begins: above a place lower than it flies; −1 if nobody may be there
    const blocked = blockedAt(0);
    return !blocked.values[code] ? code : isLow(code) ? planners.above(blocked, risk.barred, code) : -1;
  }
  function problemOf(end, least) {  // why nobody may be there, in words, and where one may
    const place = state.ends[end], index = indexOf(place), code = codeOf(index), blocked = blockedAt(least);
    if (!blocked.values[code] || risk && airborne(code) >= 0) return null;
    const here = planners.numbers("float64", place), free = planners.nearest(blocked, here, origin, cell), near = clearance.values[code];
    here.free();
    const why = risk && isLow(code) ? `lies below min_height=${live.risk.lowest} m, and there is no free way straight up from it`
      : occupied.values[code] ? "lies in a building" : closed.values[code] ? `lies in a no-fly zone${risk ? ", or nearer to a roof or the ground than a flight may be" : ""}`
      : `is ${near.toFixed(2)} m from the nearest obstacle, ${least} m are asked for`;
    return {end, words: `${end} ${shown(place)} ${why}`, free: free < 0 ? null : pointOf(free)};
  }

  function solve(offer) {
    const places = [state.ends.start, state.ends.goal], ends = places.map(place => codeOf(indexOf(place)));
    const both = `start ${shown(places[0])} and goal ${shown(places[1])}`;
    const problem = problemOf("start", keptBy(offer)) ?? problemOf("goal", keptBy(offer));
    if (problem) return {offer, reason: problem.words, problem};
    if (ends[0] === ends[1]) return {offer, reason: `${both} lie in the same voxel`};
    const [source, target] = risk ? ends.map(airborne) : ends;
    if (source === target) return {offer, reason: `${both} lie above each other, below min_height=${live.risk.lowest} m, where only take-off and landing are allowed`};
    const ask = () => { const began = performance.now(); return [SOLVERS[offer.kind](offer, [source, target], places), performance.now() - began]; };
    if (!timed.has(offer)) ask();  // the first time the browser still compiles
    timed.add(offer);
    facts.values.fill(0);  // not every planner writes each of them
    const [between, took] = ask();
    const found = between && between + source - ends[0] + target - ends[1];
    if (found > live.room) return {offer, reason: `the route has ${found} points, the page has room for ${live.room}`};
    if (found > between) {  // take-off and landing
      points.values.copyWithin(3 * (source - ends[0]), 0, 3 * between);
      for (let code = ends[0]; code < source; code++) points.values.set(pointOf(code), 3 * (code - ends[0]));
      for (let code = ends[1]; code < target; code++) points.values.set(pointOf(code), 3 * (found - 1 - code + ends[1]));
    }
    const [expanded, recorded, outcome] = ["expanded", "recorded", "outcome"].map(fact);
    const answer = {offer, took, expanded, way: points.values.slice(0, 3 * found), points: found};
    if (found === 0) return {...answer, reason: said(live.words[offer.kind === "risk" ? "no_risk" : "no_way"], {start: shown(places[0]), goal: shown(places[1]), reach: offer.kind === "theta" ? expanded : fact("reached")})};
    answer.length = planners.measure(points, found, clearance, ...walls, origin, cell, facts);
    answer.clearance = fact("nearest");
    if (risk) answer.risk = planners.integral(points, found, risk.rate, origin, cell);
    if (recorded) answer.order = order.values.slice(0, recorded);
    if (offer.kind === "field" && outcome !== 0) {
      const last = [...answer.way.slice(-3)], left = Math.hypot(...last.map((x, a) => x - places[1][a]));
      answer.reason = said(live.words.field[outcome], {place: shown(last), left: left.toFixed(1), steps: live.room - 1});
    }
    return answer;
  }
  const said = (template, words) => template.replace(/\{(\w+)(:[^}]*)?\}/g, (_, name) => words[name]);

  // --- drawing ---
  const near = place => place.map((x, a) => x - live.center[a]);
  const local = place => new THREE.Vector3(...near(place));  // in the viewer's scene, which itself is turned
  const objects = {routes: new THREE.Group(), flights: new THREE.Group(), expanded: new THREE.Group()};
  for (const group of Object.values(objects)) viewer.scene.add(group);
  function emptied(group) {
    for (const child of [...group.children]) { group.remove(child); child.geometry.dispose(); child.material.dispose(); }
    return group;
  }
  function cornersOf(way) {  // without the points in the middle of straight parts
    const places = [];
    for (let n = 0; n < way.length; n += 3) places.push([way[n], way[n + 1], way[n + 2]]);
    const along = (a, b) => { const d = b.map((x, i) => x - a[i]), size = Math.hypot(...d); return d.map(x => x / size); };
    return places.filter((place, n) => {
      if (n === 0 || n === places.length - 1) return true;
      const before = along(places[n - 1], place), after = along(place, places[n + 1]);
      return before.some((x, i) => Math.abs(x - after[i]) > 1e-9);
    });
  }
  function dashed(places, dashes, unit) {  // pieces of a polyline, drawn and left out in turn
    if (!dashes.length) return places.slice(1).map((place, n) => [places[n], place]);
    const pieces = [];
    let number = 0, left = dashes[0] * unit;
    for (let n = 1; n < places.length; n++) {
      let from = places[n - 1];
      const to = places[n];
      for (;;) {
        const size = Math.hypot(...to.map((x, a) => x - from[a])), step = Math.min(left, size);
        const there = size > 0 ? from.map((x, a) => x + step / size * (to[a] - x)) : to;
        if (number % 2 === 0) pieces.push([from, there]);
        left -= step;
        from = there;
        if (left > 1e-9) break;
        number = (number + 1) % dashes.length;
        left = dashes[number] * unit;
      }
    }
    return pieces;
  }
  function tube(pieces, radius, color) {
    const sides = 6, corners = [];
    for (const [from, to] of pieces) {
      const a = local(from), b = local(to), along = b.clone().sub(a).normalize();
      const aside = new THREE.Vector3(...(Math.abs(along.z) < 0.9 ? [0, 0, 1] : [1, 0, 0])).cross(along).normalize(), up = along.clone().cross(aside);
      const ring = [...Array(sides + 1).keys()].map(n => aside.clone().multiplyScalar(radius * Math.cos(2 * Math.PI * n / sides)).addScaledVector(up, radius * Math.sin(2 * Math.PI * n / sides)));
      a.addScaledVector(along, -0.4 * radius);
      b.addScaledVector(along, 0.4 * radius);
      for (let n = 0; n < sides; n++)
        for (const [end, m] of [[a, n], [b, n], [b, n + 1], [a, n], [b, n + 1], [a, n + 1]]) corners.push(...end.clone().add(ring[m]).toArray());
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
    geometry.computeVertexNormals();
    const seen = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({color, side: THREE.DoubleSide}));
    const through = new THREE.Mesh(geometry.clone(), new THREE.MeshBasicMaterial({color, transparent: true, opacity: 0.3, depthTest: false, depthWrite: false}));
    return [seen, through];  // what a building hides shows through it, faintly
  }
  function dots(places, color, size, opacity) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(places, 3));
    return new THREE.Points(geometry, new THREE.PointsMaterial({color, size, transparent: true, opacity, depthWrite: false}));
  }
  function lines(ends, color, opacity) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(ends, 3));
    return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color, transparent: true, opacity}));
  }
  const crosses = [], stops = [];  // where flights crashed, and where a potential field got stuck
  function stalks() {  // from each end down to the ground below it
    const ends = [];
    for (const place of Object.values(state.ends)) {
      const [i, j, k] = indexOf(place);
      let low = k;
      while (low > 0 && !occupied.values[codeOf([i, j, low - 1])]) low--;
      ends.push(...near(place), ...near([place[0], place[1], live.origin[2] + cell * low]));
    }
    const through = lines(ends, "#222", 0.25);
    through.material.depthTest = false;  // faintly, where a building hides it
    return [lines(ends, "#222", 0.9), through];
  }
  function drawRoutes(answers) {
    emptied(objects.routes).add(...stalks());
    emptied(objects.expanded);
    for (const stop of stops.splice(0)) stop.element.remove();
    for (const {offer, way, order, reason} of [...answers].sort((a, b) => (b.order?.length ?? 0) - (a.order?.length ?? 0))) {  // few above many
      if (reason && way?.length) stops.push({place: near([...way.slice(-3)]), element: drawn("stopped", offer.color)});
      if (way?.length > 3) objects.routes.add(...tube(dashed(cornersOf(way), offer.dashes, live.width), live.width / 2, offer.color));
      if (order && at("expanded").checked) {
        const step = Math.ceil(order.length / 40000), places = [];
        for (let n = 0; n < order.length; n += step) places.push(...near(pointOf(order[n])));
        const seen = dots(places, offer.color, 0.45 * cell, 0.35);
        seen.renderOrder = objects.expanded.children.length;
        objects.expanded.add(seen);
      }
    }
    viewer.set_dirty();
  }
  function forgetFlights() {
    emptied(objects.flights);
    for (const cross of crosses.splice(0)) cross.element.remove();
    for (const row of document.querySelectorAll("#offers .flown")) {  // counts stay to be compared with the next
      if (!row.dataset.crashed && !row.classList.contains("before")) row.textContent = "";  // it wasn't through
      row.classList.add("before");
      delete row.dataset.crashed;
    }
    stopped();
  }

  // --- answers ---
  const failed = error => error instanceof RangeError ? "the page has no more memory for this" : error.message;
  let answers = [];
  function plan() {
    if (live.curve) { bend(); return; }
    forgetFlights();
    answers = live.offers.filter(offer => state.shown.has(offer.name)).map(offer => {
      try { return solve(offer); } catch (error) { return {offer, reason: failed(error)}; }
    });
    drawRoutes(answers);
    for (const offer of live.offers) tell(offer, answers.find(answer => answer.offer === offer));
    const problem = answers.find(answer => answer.problem)?.problem;
    at("wrong").hidden = !problem;
    if (problem) {
      at("wrong").firstElementChild.textContent = `${problem.words[0].toUpperCase()}${problem.words.slice(1)}.`;
      const button = at("instead");
      button.hidden = problem.free === null;
      button.textContent = problem.free ? `Move it to the nearest free point ${shown(problem.free)}` : "";
      button.onclick = () => move(problem.end, problem.free);
    }
    at("where").textContent = Object.entries(state.ends).map(([end, place]) => `${end} at ${shown(place)} m` + (risk ? `, where r = ${power(risk.rate.values[codeOf(indexOf(place))])} deaths an hour` : "")).join("; ");
    for (const handle of handles) handle.element.classList.toggle("wrong", answers.some(answer => answer.problem?.end === handle.end));
    at("python").textContent = asPython();
    remember();
    document.body.dataset.planned = String(Number(document.body.dataset.planned ?? 0) + 1);
  }
  const bends = live.curve && planners.empty("float64", live.room), control = live.curve && planners.empty("float64", live.ends.length, 3);
  function bend() {  // a curve in place of routes
    const places = Object.values(state.ends);
    control.set(places.flat());
    const began = performance.now(), found = planners.curve(control, places.length, live.curve.step, live.curve.bank, clearance, ...walls, origin, cell, points, bends, facts);
    const took = performance.now() - began, [row] = live.offers, [length, nearest, tightest, fastest, steepest] = ["cost", "nearest", "bend", "fastest", "steepest"].map(fact);
    emptied(objects.routes);
    if (found <= live.room && state.shown.has(row.name)) objects.routes.add(...tube(dashed(cornersOf(points.values.slice(0, 3 * found)), row.dashes, live.width), live.width / 2, row.color));
    objects.routes.add(lines(places.slice(1).flatMap((place, n) => [...near(places[n]), ...near(place)]), "#222", 0.6), ...stalks());
    const words = at("offer-0").querySelector(".found");
    words.textContent = found > live.room ? "the curve is too long for the page" : [`${per(length, 1)} m long`, nearest > 0 ? `clearance ${per(nearest, 2)} m` : "it touches a building",
      tightest > 1e-9 ? `tightest bend ${per(1 / tightest, 1)} m of radius: ${per(fastest, 1)} m/s at a bank of ${live.curve.degrees}°` : "straight",
      `climbs or sinks by ${per(Math.asin(steepest) * 180 / Math.PI, 0)}° at most`, `${per(took, 1)} ms`].join(" · ");
    words.dataset.length = String(length);
    at("python").textContent = `from uavlab.spline import Curve\n\ncurve = Curve([\n${places.map(place => `    ${python(place)},`).join("\n")}\n], step=${live.curve.step})\nprint(curve.length, curve.clearance(city), curve.level_curvature.max(), abs(curve.pitch).max())`;
    remember();
    viewer.set_dirty();
    document.body.dataset.planned = String(Number(document.body.dataset.planned ?? 0) + 1);
  }
  const per = (x, digits) => x.toLocaleString("en", {minimumFractionDigits: digits, maximumFractionDigits: digits});
  function tell(offer, answer) {
    const row = at(`offer-${live.offers.indexOf(offer)}`), words = row.querySelector(".found");
    words.textContent = !answer ? "" : answer.reason && !answer.length ? `${answer.reason[0].toUpperCase()}${answer.reason.slice(1)}` : [
      answer.reason ? `doesn’t arrive: ${answer.reason}` : `${per(answer.length, 1)} m`,
      answer.clearance === Infinity ? "" : `clearance ${per(answer.clearance, 2)} m`,
      answer.risk === undefined ? "" : `${power(answer.risk * live.risk.scale)} deaths a flight`,
      `${per(answer.expanded, 0)} ${offer.kind === "field" ? "steps" : "expanded"}`, `${per(answer.took, answer.took < 10 ? 1 : 0)} ms`,
    ].filter(Boolean).join(" · ");
    words.dataset.length = answer?.reason ? "" : String(answer?.length ?? "");
  }
  function power(x) {  // 4.0·10⁻¹⁰
    const [digits, exponent] = x.toExponential(1).split("e");
    return `${digits}·10${[...exponent.replace("+", "")].map(sign => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(sign)]).join("")}`;
  }
  function asPython() {
    const numbersOf = {start: python(state.ends.start), goal: python(state.ends.goal), ...state.values, conditions: conditions()?.python, wind: windWords()};
    const chosen = live.offers.filter(offer => state.shown.has(offer.name));
    const calls = chosen.map(offer => said(offer.python[value("keep") === 0 && offer.python.length > 1 ? 1 : 0], numbersOf));
    const taken = new Map();  // from which module what
    for (const line of [...chosen.flatMap(offer => offer.imports), ...(live.flights?.imports ?? [])]) {
      const [module, names] = line.slice("from ".length).split(" import ");
      taken.set(module, [...new Set([...(taken.get(module) ?? []), ...names.split(", ")])].sort());
    }
    return [...[...taken].sort().map(([module, names]) => `from ${module} import ${names.join(", ")}`), "", `# ${live.given} as in the page`,
            "routes = {", ...calls.map((call, n) => `    ${JSON.stringify(chosen[n].name)}: ${call},`), "}",
            ...(live.flights ? [said(live.flights.python, numbersOf)] : [])].join("\n");
  }

  // --- flights ---
  let flying = null;
  const windOf = () => {
    const turn = value("towards") * Math.PI / 180, speed = value("wind");
    return [speed * Math.sin(turn), speed * Math.cos(turn), 0].map(x => Math.round(1e6 * x) / 1e6 + 0);
  };
  const windWords = () => live.flights ? `(${windOf().slice(0, 2).join(", ")})` : "";
  function stopped() {
    flying = null;
    if (live.flights) at("fly").textContent = flyWords;
  }
  const flyWords = live.flights && at("fly").textContent;
  const flownBy = answer => at(`offer-${live.offers.indexOf(answer.offer)}`).querySelector(".flown");
  async function fly() {
    forgetFlights();
    const mine = flying = {}, ways = answers.filter(answer => answer.length && !answer.reason);
    at("fly").textContent = "Stop";
    for (const answer of ways) {
      flownBy(answer).classList.remove("before");
      try { await flyAlong(answer, mine); } catch (error) { flownBy(answer).textContent = failed(error); }
      if (flying !== mine) return;
    }
    stopped();
    document.body.dataset.flown = String(Number(document.body.dataset.flown ?? 0) + 1);
  }
  function crossAt(place, words) {
    const element = drawn("crash", live.crash);
    element.classList.add("crash");
    element.style.display = "none";  // until it is put in its place
    element.appendChild(document.createElementNS(element.namespaceURI, "title")).textContent = words;
    return {place, element};
  }
  async function flyAlong(answer, mine) {
    const {total, craft, speed, touching, near: nearGoal, step, every, gust, head} = live.flights, row = flownBy(answer);
    const blowing = windOf(), mean = Math.hypot(...blowing), strongest = planners.strongest(mean, value("gusts"));
    if (strongest > gust || mean > head) {
      row.textContent = strongest > gust ? `stays on the ground: gusts of ${per(strongest, 1)} m/s, and the thrust holds ${per(gust, 1)} m/s` : `stays on the ground: the mean wind of ${per(mean, 1)} m/s leaves no way against it`;
      return;
    }
    const words = new BigUint64Array(buffer.slice(kept("states"), kept("states") + 32 * total).buffer), intervals = floats("intervals", 2 * (total + 1));
    const taken = [planners.numbers("float64", answer.way, [answer.points, 3]), planners.numbers("float64", blowing), planners.numbers("float64", craft),
      planners.empty("uint64", 4), planners.empty("float64", 4000, 12)];
    const [way, wind, numbersOf, flightState, log] = taken, tracks = [];
    let crashed = 0, gaveUp = 0;
    for (let number = 0; number < total && flying === mine; number++) {
      flightState.set(words.subarray(4 * number, 4 * number + 4));
      const rows = Math.min(planners.fly(way, answer.points, speed, wind, value("gusts"), live.flights.memory, numbersOf, step, every, touching, nearGoal,
        occupied, clearance, ...walls, origin, cell, flightState, log, facts), 4000), outcome = fact("outcome"), seen = log.values;
      crashed += outcome === 2;
      gaveUp += outcome === 3 || outcome === 4 || outcome === 0;
      if (outcome === 2) crosses.push(crossAt(near([1, 2, 3].map(a => seen[12 * (rows - 1) + a])), `${answer.offer.name}, flight ${number + 1}`));
      if (number < 60)
        for (let n = 1; n < rows; n++) tracks.push(...[n - 1, n].flatMap(m => near([1, 2, 3].map(a => seen[12 * m + a]))));
      if (number % 10 === 0) {
        row.textContent = `flight ${number} of ${total} …`;
        viewer.set_dirty();
        await new Promise(requestAnimationFrame);
      }
    }
    for (const numbers of taken) numbers.free();
    if (flying !== mine) return;
    objects.flights.add(lines(tracks, answer.offer.color, 0.45));
    const [low, high] = intervals.slice(2 * crashed, 2 * crashed + 2);
    row.textContent = `${crashed} of ${total} crash: ${per(1000 * crashed / total, 0)} per 1 000 (95 %: ${per(1000 * low, 0)} to ${per(1000 * high, 0)})` + (gaveUp ? `; ${gaveUp} give up` : "");
    row.dataset.crashed = crashed;
    viewer.set_dirty();
  }

  // --- ends to drag ---
  const rays = new THREE.Raycaster();
  function rayAt(event) {
    const box = pane.getBoundingClientRect();
    rays.setFromCamera({x: 2 * (event.clientX - box.left) / box.width - 1, y: 1 - 2 * (event.clientY - box.top) / box.height}, camera);
    return rays.ray;
  }
  const placeOf = vector => [vector.x, -vector.z, vector.y].map((x, a) => x + live.center[a]);
  function move(end, place) {
    const to = snapped(place);
    if (to.every((x, a) => x === state.ends[end][a])) return;
    state.ends[end] = to;
    later();
  }
  let waiting = false;
  function later() {
    viewer.set_dirty();
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; plan(); });
  }
  const handles = live.ends.map(([end], number) => {
    const element = drawn(number === 0 ? "start" : number === live.ends.length - 1 ? "goal" : "stopped", "#222");
    element.classList.add("handle");
    element.setAttribute("tabindex", "0");
    element.setAttribute("role", "button");
    const SVG = element.namespaceURI, name = end[0].toUpperCase() + end.slice(1);
    for (const [kind, path, title] of [["level", "M-14 0a14 14 0 1 0 28 0a14 14 0 1 0-28 0", `${name}: drag it over the map`], ["height", "M0-44l6 8h-4v10h4l-6 8-6-8h4v-10h-4z", `${name}: drag its height`]]) {
      const grip = element.appendChild(document.createElementNS(SVG, "path"));
      grip.setAttribute("d", path);
      grip.setAttribute("class", kind);
      grip.appendChild(document.createElementNS(SVG, "title")).textContent = title;
      grip.addEventListener("pointerdown", event => {
        event.preventDefault();
        event.stopPropagation();
        element.focus();
        grip.setPointerCapture(event.pointerId);
        controls.enabled = false;
        const from = world(near(state.ends[end])), upright = kind === "height" || event.shiftKey;
        const facing = camera.getWorldDirection(new THREE.Vector3()), up = new THREE.Vector3(0, 1, 0).transformDirection(camera.matrixWorld);
        const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(upright ? facing : new THREE.Vector3(0, 1, 0), from);
        const offset = rayAt(event).intersectPlane(plane, new THREE.Vector3())?.sub(from) ?? new THREE.Vector3();
        const drag = event => {
          const hit = rayAt(event).intersectPlane(plane, new THREE.Vector3())?.sub(offset);
          if (!hit) return;
          const [x, y, z] = state.ends[end], risen = hit.clone().sub(from).dot(up) / Math.max(up.y, 0.5);  // from above, too
          move(end, upright ? [x, y, placeOf(from)[2] + risen] : [...placeOf(hit).slice(0, 2), z]);
        };
        const done = () => { grip.removeEventListener("pointermove", drag); controls.enabled = true; };
        grip.addEventListener("pointermove", drag);
        grip.addEventListener("pointerup", done, {once: true});
        grip.addEventListener("pointercancel", done, {once: true});
      });
    }
    element.addEventListener("keydown", event => {
      const step = {ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0], PageUp: [0, 0, 1], PageDown: [0, 0, -1]}[event.key];
      if (!step) return;
      event.preventDefault();
      event.stopPropagation();
      move(end, state.ends[end].map((x, a) => x + (live.curve ? 1 : cell) * (event.shiftKey ? 10 : 1) * step[a]));
    });
    return {end, element};
  });
  function hidden(place) {  // by a building, from where the camera stands
    const eye = placeOf(camera.position), away = eye.map((x, a) => x - place[a]), size = Math.hypot(...away), top = live.origin.map((x, a) => x + cell * live.shape[a]);
    for (let way = cell; way < size; way += cell / 2) {
      const here = place.map((x, a) => x + way / size * away[a]);
      if (here.some((x, a) => x < live.origin[a] || x >= top[a])) return false;
      if (occupied.values[codeOf(indexOf(here))]) return true;
    }
    return false;
  }
  stage.after.push(() => {
    for (const {end, element} of handles) {
      put(element, near(state.ends[end]), true);
      element.classList.toggle("behind", hidden(state.ends[end]));
      element.setAttribute("aria-label", `${end} at ${shown(state.ends[end])} m; arrow keys move it, Page Up and Page Down change its height`);
    }
    for (const {element, place} of [...crosses, ...stops]) put(element, place, true);
  });

  // --- the panel ---
  live.offers.forEach((offer, number) => {
    const box = at(`offer-${number}`).querySelector("input");
    box.onchange = () => { if (box.checked) state.shown.add(offer.name); else state.shown.delete(offer.name); later(); };
  });
  function showValues() {
    live.offers.forEach((offer, number) => { at(`offer-${number}`).querySelector("input").checked = state.shown.has(offer.name); });
    for (const {name, unit} of live.sliders) {
      at(`set-${name}`).value = String(value(name));
      const output = at(`is-${name}`);
      if (output) output.textContent = `${value(name)}${unit}`;
    }
    if (live.flights) stage.scene.wind = value("wind") > 0 ? windOf().slice(0, 2) : null;
  }
  for (const {name, plans} of live.sliders)
    at(`set-${name}`).oninput = event => {
      state.values[name] = Number(event.target.value);
      showValues();
      if (plans) later(); else { forgetFlights(); at("python").textContent = asPython(); remember(); viewer.set_dirty(); }
    };
  if (live.flights) at("fly").onclick = () => { if (flying) { forgetFlights(); viewer.set_dirty(); } else fly(); };
  if (live.expansions) at("expanded").onchange = () => drawRoutes(answers);
  at("again").onclick = () => { startOver(); showValues(); later(); };
  at("link").onclick = async () => {
    const page = alone ? location : outside();
    const text = `${page ? page.href.split("#")[0] : ""}#${fragment()}`;
    try { await navigator.clipboard.writeText(text); at("link").textContent = "Link copied"; }
    catch { at("linked").value = text; at("linked").hidden = false; at("linked").select(); }
    setTimeout(() => { at("link").textContent = "Copy link"; }, 2000);
  };

  // --- the address ---
  const alone = window.parent === window;
  function outside() { try { return window.parent.location; } catch { return null; } }  // a notebook's frame may not be asked
  function fragment() {
    const fields = {scene: live.id, ...state.ends, show: live.offers.map((offer, n) => state.shown.has(offer.name) ? n : null).filter(n => n !== null), ...state.values};
    return Object.entries(fields).map(([name, field]) => `${name}=${[field].flat().join(",")}`).join("&");
  }
  function remember() { if (alone) history.replaceState(null, "", `#${fragment()}`); }
  function recall() {
    const fields = new URLSearchParams((alone ? location : outside())?.hash.slice(1) ?? "");
    if (fields.get("scene") !== live.id) return;
    if (!alone) window.frameElement.scrollIntoView({block: "center"});
    for (const [end] of live.ends) {
      const place = fields.get(end)?.split(",").map(Number);
      if (place?.length === 3 && place.every(Number.isFinite)) state.ends[end] = snapped(place);
    }
    for (const {name, least, most} of live.sliders) {
      const number = Number(fields.get(name) ?? NaN);
      if (number >= least && number <= most) state.values[name] = number;
    }
    if (fields.has("show")) state.shown = new Set(fields.get("show").split(",").map(n => live.offers[n]?.name).filter(Boolean));
  }

  stage.withoutRoutes();
  at("live").classList.add("ready");
  at("legend").open = true;
  at("legend").querySelector("summary").textContent = live.curve ? "Curve" : "Planners";
  recall();
  showValues();
  plan();
  viewer.render();
  document.body.dataset.live = "yes";
}

async function beginLive(stage, unpack, read, packed) {
  try {
    if (typeof WebAssembly !== "object") throw new Error("there is no WebAssembly");
    const planners = await loadPlanners(new Uint8Array(await unpack(packed.wasm)), await read("facts"));
    playLive(stage, planners, await read("told"), new Uint8Array(await unpack(packed.kept)));
  } catch (error) {
    const words = document.getElementById("lifeless");
    words.textContent = `The planners can't run in this browser: the scene shows the routes as they were planned at first. (${error.message})`;
    words.hidden = false;
    document.body.dataset.live = "no";
  }
}
