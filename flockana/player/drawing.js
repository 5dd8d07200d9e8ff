// One instant of a run on a canvas.
const ON_DARK = ["#4a9df0", "#5f98d0", "#7296b8", "#8298a8", "#8a8a8a", "#a8957a", "#cf9a50", "#e8a940", "#ffc84a"];
const STRAINS = ["#00356b", "#1d5898", "#3d76b2", "#6480a0", "#8a8a8a", "#ab8a62", "#cf8a33", "#e5a033", "#f5b83d"];
const GROUPS = ["--ink", "--blue", "--vermillion", "--green", "--purple"];

function flockanaDrawing(canvas, run) {
  const { n, m } = run, frames = run.t.length, ink = canvas.getContext("2d");
  const places = new Float64Array(n * m), speeds = new Float64Array(n * m);
  const screen = new Float64Array(2 * n), look = { trails: true, velocities: true, links: true, follow: false };
  const view = { x: 0, y: 0, scale: 1, turn: 0.6, tilt: 0.5 };
  let colours = {}, strains = STRAINS, width = 1, height = 1;

  const fastest = Math.max(1e-300, ...chunks(run.p, m).map((v) => Math.hypot(...v)));
  const box = extent();
  function chunks(values, size) {  // few of them, for bounds
    const found = [], skip = Math.max(1, Math.floor(values.length / size / 20000));
    for (let i = 0; i < values.length; i += size * skip) found.push(values.subarray(i, i + size));
    return found;
  }
  function extent() {
    const low = Array(m).fill(Infinity), high = Array(m).fill(-Infinity);
    const take = (x) => x.forEach((v, c) => { low[c] = Math.min(low[c], v); high[c] = Math.max(high[c], v); });
    for (const name of ["q", "stars", "crosses"]) if (run[name]) chunks(run[name], m).forEach((x) => take([...x]));
    for (const { kind, par } of run.solids) if (kind === "sphere") {
      const r = par[m];
      take(par.slice(0, m).map((v) => v - r)); take(par.slice(0, m).map((v) => v + r));
    }
    run.outlines.forEach((line) => line.forEach(take));
    return { centre: low.map((v, c) => 0.5 * (v + high[c])), low, high };
  }
  const size = Math.max(...box.high.map((v, c) => v - box.low[c])) || 1;

  function palette() {
    const style = getComputedStyle(canvas);
    for (const name of ["--ink", "--muted", "--faint", "--paper", "--blue", "--vermillion", "--green", "--purple"])
      colours[name] = style.getPropertyValue(name).trim() || "#888";
    strains = matchMedia("(prefers-color-scheme: dark)").matches ? ON_DARK : STRAINS;
  }
  function resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    width = canvas.clientWidth || 600; height = canvas.clientHeight || 400;
    canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
    ink.setTransform(ratio, 0, 0, ratio, 0, 0);
  }
  function fit() {
    const spans = box.high.map((v, c) => v - box.low[c] || 0);
    view.x = 0; view.y = 0;
    const across = m === 3 ? Math.hypot(...spans) : spans[0], up = m === 3 ? across : spans[1] || 0;
    view.scale = 0.9 * Math.min(width / (across || size), height / (up || size * height / width * 0.2));
  }
  const whole = box.centre;
  function middle() {
    return whole.map((_, c) => { let sum = 0; for (let i = c; i < n * m; i += m) sum += places[i]; return sum / n; });
  }
  function follow(on) {  // the flock, as large as it is now
    look.follow = on;
    if (!on) { fit(); return; }
    const centre = middle();
    let far = 0;
    for (let i = 0; i < n; i++) far = Math.max(far, Math.hypot(...centre.map((v, c) => places[i * m + c] - v)));
    view.x = 0; view.y = 0;
    if (far > 0) view.scale = Math.min(0.42 * Math.min(width, height) / far, 200 * view.scale);
  }
  let turned = { a: 1, b: 0, c: 0, d: 1 };
  function project(x, i) {  // to pixels
    let u = x[i] - box.centre[0], v = m > 1 ? x[i + 1] - box.centre[1] : 0;
    if (m === 3) {
      const w = x[i + 2] - box.centre[2], { a, b, c, d } = turned;
      const deep = b * u + a * v;
      u = a * u - b * v; v = c * deep + d * w;
    }
    return [width / 2 + view.x + view.scale * u, height / 2 + view.y - view.scale * v];
  }

  function interpolate(time) {
    const t = run.t;
    let low = 0, high = frames - 1;
    while (high - low > 1) { const k = (low + high) >> 1; if (t[k] <= time) low = k; else high = k; }
    const h = t[high] - t[low] || 1, s = Math.min(1, Math.max(0, (time - t[low]) / h));
    const i = low * n * m, j = high * n * m, { q, p } = run, s2 = s * s, s3 = s2 * s;
    for (let k = 0; k < n * m; k++) {  // a cubic that has both places and both velocities, unless these overshoot
      const jump = q[j + k] - q[i + k], p0 = h * p[i + k], p1 = h * p[j + k], most = 3 * Math.abs(jump);
      const smooth = Math.abs(p0) <= most && Math.abs(p1) <= most;
      places[k] = smooth
        ? q[i + k] + (3 * s2 - 2 * s3) * jump + (s3 - 2 * s2 + s) * p0 + (s3 - s2) * p1 : q[i + k] + s * jump;
      speeds[k] = (1 - s) * p[i + k] + s * p[j + k];
    }
    return { low, share: s, near: s < 0.5 ? low : high };
  }
  function mixed(values, count, at) {
    const from = at.low * count, to = Math.min(at.low + 1, frames - 1) * count;
    return Float64Array.from({ length: count }, (_, k) => (1 - at.share) * values[from + k] + at.share * values[to + k]);
  }

  function forPairs(reach, visit) {  // of agents nearer than reach: a grid of cells
    const cells = new Map(), key = (x, y, z) => (x * 73856093) ^ (y * 19349663) ^ (z * 83492791);
    const cell = new Int32Array(3 * n);
    for (let i = 0; i < n; i++) {
      for (let c = 0; c < m; c++) cell[3 * i + c] = Math.floor(places[i * m + c] / reach);
      const k = key(cell[3 * i], cell[3 * i + 1], cell[3 * i + 2]), list = cells.get(k);
      if (list) list.push(i); else cells.set(k, [i]);
    }
    const around = m === 3 ? [-1, 0, 1] : [0], beside = m > 1 ? [-1, 0, 1] : [0];
    for (let i = 0; i < n; i++) {
      const seen = new Set();
      for (const x of [-1, 0, 1]) for (const y of beside) for (const z of around) {
        const k = key(cell[3 * i] + x, cell[3 * i + 1] + y, cell[3 * i + 2] + z);
        if (seen.has(k)) continue;
        seen.add(k);
        for (const j of cells.get(k) || []) {
          if (j <= i) continue;
          let squared = 0;
          for (let c = 0; c < m; c++) squared += (places[i * m + c] - places[j * m + c]) ** 2;
          if (squared < reach * reach) visit(i, j, Math.sqrt(squared));
        }
      }
    }
  }
  function links(at) {
    const paths = STRAINS.map(() => []), { reach, length } = run;
    if (run.edges) {
      const fixed = run.edge_counts.length === 1, frame = fixed ? 0 : at.near;
      let first = 0;
      for (let k = 0; k < frame; k++) first += run.edge_counts[k];
      for (let k = first; k < first + run.edge_counts[frame]; k++) paths[4].push(run.edges[2 * k], run.edges[2 * k + 1]);
    } else if (reach) {
      const limit = length ? Math.min(1, Math.max(reach / length - 1, 1e-9)) : 1;
      forPairs(reach, (i, j, distance) => {
        const strain = length ? (distance - length) / length / limit : 0;
        paths[Math.round(4 + 4 * Math.max(-1, Math.min(1, strain)))].push(i, j);
      });
    }
    const count = paths.reduce((sum, list) => sum + list.length / 2, 0);
    ink.lineWidth = Math.min(1.8, Math.max(0.4, 120 / n)) * Math.min(1, Math.sqrt(4 * n / Math.max(1, count)));
    paths.forEach((list, k) => {
      if (!list.length) return;
      ink.beginPath();
      for (let e = 0; e < list.length; e += 2) {
        ink.moveTo(screen[2 * list[e]], screen[2 * list[e] + 1]);
        ink.lineTo(screen[2 * list[e + 1]], screen[2 * list[e + 1] + 1]);
      }
      ink.strokeStyle = length ? strains[k] : colours["--muted"];
      ink.stroke();
    });
  }

  function closest(solid, x) {  // the β-agent and its distance
    const { kind, par } = solid;
    if (kind === "sphere") {
      const away = x.map((v, c) => v - par[c]), far = Math.hypot(...away) || 1;
      return [away.map((v, c) => par[c] + v * par[m] / far), far - par[m]];
    }
    const off = x.reduce((sum, v, c) => sum + par[m + c] * (v - par[c]), 0);
    return [x.map((v, c) => v - off * par[m + c]), off];
  }
  function obstacles() {
    ink.fillStyle = colours["--faint"]; ink.strokeStyle = colours["--muted"]; ink.lineWidth = 1;
    for (const { kind, par } of run.solids) {
      ink.beginPath();
      if (kind === "sphere") {
        const [x, y] = project(par, 0), r = par[m] * view.scale;
        if (m === 1) ink.rect(x - r, y - 8, 2 * r, 16); else ink.arc(x, y, r, 0, 7);
        ink.fill(); ink.stroke();
      } else if (kind === "wall" && m === 2) {
        const [x, y] = project(par, 0), far = 2 * (width + height), [a, b] = [par[2], par[3]];
        ink.moveTo(x - b * far, y - a * far); ink.lineTo(x + b * far, y + a * far);
        ink.lineTo(x + b * far - a * far, y + a * far + b * far);
        ink.lineTo(x - b * far - a * far, y - a * far + b * far);
        ink.fill(); ink.stroke();
      } else if (kind === "wall" && m === 3) {
        for (const ends of patch(par)) ends.forEach((x, k) => { const [u, v] = project(x, 0); if (k) ink.lineTo(u, v); else ink.moveTo(u, v); });
        ink.stroke();
      }
    }
    for (const line of run.outlines) {
      ink.beginPath();
      line.forEach((x, k) => { const [u, v] = project(x, 0); if (k) ink.lineTo(u, v); else ink.moveTo(u, v); });
      ink.closePath();
      if (line.length > 4 && m < 3) ink.fill();  // in space they are wires about a solid
      ink.stroke();
    }
  }
  function patch(par) {  // of a wall in space, about the foot of the run's centre: a grid of lines
    const a = par.slice(3), [foot] = closest({ kind: "wall", par }, whole), k = a.map(Math.abs).indexOf(Math.min(...a.map(Math.abs)));
    const cross = (x, y) => [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
    const across = cross(a, [0, 1, 2].map((c) => (c === k ? 1 : 0))), long = Math.hypot(...across), u = across.map((c) => c / long), v = cross(a, u);
    const at = (x, y) => foot.map((c, i) => c + 0.6 * size * (x * u[i] + y * v[i]));
    return [-1, -0.5, 0, 0.5, 1].flatMap((x) => [[at(x, -1), at(x, 1)], [at(-1, x), at(1, x)]]);
  }
  function betaAgents() {
    if (!run.beta) return;
    ink.strokeStyle = colours["--purple"]; ink.fillStyle = colours["--paper"]; ink.lineWidth = 1;
    for (const solid of run.solids) if (solid.kind !== "other") for (let i = 0; i < n; i++) {
      const [foot, distance] = closest(solid, Array.from(places.subarray(i * m, i * m + m)));
      if (distance >= run.beta) continue;
      const [x, y] = project(foot, 0);
      ink.setLineDash([2, 3]); ink.beginPath(); ink.moveTo(screen[2 * i], screen[2 * i + 1]); ink.lineTo(x, y);
      ink.stroke(); ink.setLineDash([]);
      ink.beginPath(); ink.moveTo(x, y - 4); ink.lineTo(x + 4, y); ink.lineTo(x, y + 4); ink.lineTo(x - 4, y);
      ink.closePath(); ink.fill(); ink.stroke();
    }
  }
  function trails(at) {
    const many = Math.max(2, Math.min(at.low + 1, Math.floor(40000 / n), Math.ceil(frames / 8)));
    ink.strokeStyle = colours["--muted"]; ink.globalAlpha = 0.35; ink.lineWidth = 0.8; ink.beginPath();
    for (let i = 0; i < n; i++) {
      for (let k = Math.max(0, at.low + 1 - many); k <= at.low; k++) {
        const [x, y] = project(run.q, (k * n + i) * m);
        if (k === Math.max(0, at.low + 1 - many)) ink.moveTo(x, y); else ink.lineTo(x, y);
      }
      ink.lineTo(screen[2 * i], screen[2 * i + 1]);
    }
    ink.stroke(); ink.globalAlpha = 1;
  }
  function arrows() {
    const long = 0.07 * width / fastest, tip = new Float64Array(m);
    ink.strokeStyle = ink.fillStyle = colours["--green"]; ink.lineWidth = Math.min(1.4, Math.max(0.7, 200 / n));
    ink.beginPath();
    for (let i = 0; i < n; i++) {
      for (let c = 0; c < m; c++) tip[c] = places[i * m + c] + speeds[i * m + c] * long / view.scale;
      const [x, y] = project(tip, 0), u = x - screen[2 * i], v = y - screen[2 * i + 1], far = Math.hypot(u, v);
      if (far < 1.5) continue;
      const head = Math.min(5, 0.4 * far) / far;
      ink.moveTo(screen[2 * i], screen[2 * i + 1]); ink.lineTo(x, y);
      ink.moveTo(x - head * (u - 0.5 * v), y - head * (v + 0.5 * u)); ink.lineTo(x, y);
      ink.lineTo(x - head * (u + 0.5 * v), y - head * (v - 0.5 * u));
    }
    ink.stroke();
  }
  function agents() {
    const near = (run.length || run.reach || Infinity) * view.scale;
    const r = Math.max(1.2, Math.min(4.5, 45 / Math.sqrt(n), 0.25 * near)), groups = run.groups.length ? run.groups : null;
    for (let g = 0; g < (groups ? GROUPS.length - 1 : 1); g++) {
      ink.beginPath();
      for (let i = 0; i < n; i++) {
        if (groups && groups[i] % (GROUPS.length - 1) !== g) continue;
        const x = screen[2 * i], y = screen[2 * i + 1];
        ink.moveTo(x + r, y); ink.arc(x, y, r, 0, 6.2832);
      }
      ink.fillStyle = colours[GROUPS[groups ? g + 1 : 0]];
      ink.fill();
    }
  }
  function marks(at) {
    for (const [name, cross] of [["stars", false], ["crosses", true]]) {
      if (!run[name]) continue;
      const count = run[name].length / frames, now = mixed(run[name], count, at);
      ink.fillStyle = colours["--vermillion"]; ink.strokeStyle = colours["--paper"]; ink.lineWidth = 1;
      for (let k = 0; k < count; k += m) {
        const [x, y] = project(now, k), points = cross ? 8 : 10;
        ink.beginPath();
        for (let i = 0; i < points; i++) {
          const r = cross ? (i % 2 ? 3 : 9) : (i % 2 ? 4 : 10), a = 2 * Math.PI * (i / points) - (cross ? Math.PI / 4 : Math.PI / 2);
          ink.lineTo(x + r * Math.cos(a), y + r * Math.sin(a));
        }
        ink.closePath(); ink.fill(); ink.stroke();
      }
    }
  }
  function draw(time) {
    const at = interpolate(time);
    box.centre = look.follow ? middle() : whole;
    turned = { a: Math.cos(view.turn), b: Math.sin(view.turn), c: Math.sin(view.tilt), d: Math.cos(view.tilt) };
    ink.clearRect(0, 0, width, height);
    for (let i = 0; i < n; i++) [screen[2 * i], screen[2 * i + 1]] = project(places, i * m);
    obstacles();
    if (look.trails) trails(at);
    if (look.links) links(at);
    if (look.velocities) arrows();
    agents(); betaAgents(); marks(at);
  }
  return { draw, fit, follow, resize, palette, project, view, look };
}
