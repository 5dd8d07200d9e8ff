// Verdicts, and the poles with the modes that move when they are chosen.
function explorerAnswers(verdicts, poles, strip) {
  const make = (kind, words, parent, attributes = {}, space = null) => {
    const node = space ? document.createElementNS(space, kind) : document.createElement(kind);
    if (words) node.textContent = words;
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    parent.append(node);
    return node;
  };
  const short = (value) => String(Number(Number(value).toPrecision(4)));
  const open = new Set();
  let rows = new Map(), chips = new Map(), before = new Map(), stop = () => {};
  const marks = { verified: "✓", refuted: "✗", vacuous: "∅", inconclusive: "?" };

  function expect(theorems) {
    rows = new Map();
    for (const [id, chip] of chips) before.set(id, chip.dataset.status || before.get(id));
    chips = new Map();
    verdicts.replaceChildren();
    strip.replaceChildren();
    if (!theorems.length) make("p", "No theorem of the catalogue is checked on this law.", verdicts, { class: "muted" });
    for (const { id, title } of theorems) {
      const row = make("details", "", verdicts, { class: "verdict", id: `verdict-${id}` }), line = make("summary", "", row);
      make("span", "…", line, { class: "status" });
      line.append(` ${id}: ${title}`);
      row.open = open.has(id);
      row.addEventListener("toggle", () => { if (row.open) open.add(id); else open.delete(id); });
      rows.set(id, row);
      const chip = make("button", `… ${id}`, make("li", "", strip), { type: "button", title });
      chip.addEventListener("click", () => { row.open = true; row.scrollIntoView({ block: "center" }); line.focus(); });
      chips.set(id, chip);
    }
    stop();
    poles.replaceChildren();
    make("p", "after the run and its verdicts …", poles, { class: "muted" });
  }
  function verdict(found) {
    const row = rows.get(found.theorem);
    if (!row) return;
    const chip = chips.get(found.theorem), was = before.get(found.theorem);
    chip.textContent = `${marks[found.status] || "–"} ${found.theorem}`;
    chip.className = found.status.replace(" ", "-");
    chip.dataset.status = found.status;
    chip.setAttribute("aria-label", `${found.theorem}: ${found.status}`);
    if (was && was !== found.status) chip.classList.add("changed");
    const status = row.querySelector(".status");
    status.textContent = found.status;
    status.className = `status ${found.status}`;
    row.querySelectorAll("p, ul").forEach((node) => node.remove());
    if (found.summary) make("p", found.summary, row);
    make("p", found.error || found.statement, row, { class: "muted" });
    const unmet = new Set(found.hypotheses.filter(({ status }) => status === "unmet").map(({ name }) => name));
    const list = (items, words) => {
      if (!items.length) return;
      const all = make("ul", "", row, { "aria-label": words });
      for (const { status: how, name, detail, margin, rigour, by, needs } of items) {
        const item = make("li", "", all);
        make("span", how, item, { class: `status ${how}` });
        const missed = how === "vacuous" && (needs || []).find((need) => unmet.has(need));
        const more = [missed && !detail.startsWith(missed) ? `unmet: ${missed}` : "", detail, margin === null || margin === undefined ? "" : `margin ${Number.isFinite(Number(margin)) ? short(margin) : margin}`, rigour || ""];
        const whose = by && by !== found.author ? `${found.bylines[by]}: ` : "";
        item.append(` ${whose}${name}: ${more.filter(Boolean).join("; ")}`);
      }
    };
    list(found.hypotheses, "Hypotheses");
    list(found.claims, "Claims");
  }

  function spectrum(found) {
    stop();
    poles.replaceChildren();
    make("p", `${found.note}.${found.zero && found.zero.length ? ` Zero modes: ${found.zero.join(", ")}.` : ""}` +
      (found.abscissa === null || found.abscissa === undefined ? "" : ` Spectral abscissa ${short(found.abscissa)}.`), poles);
    if (!found.poles || !found.modes.length) return;
    const svg = map(found.poles), canvas = make("canvas", "", poles, { role: "img", "aria-label": "A mode" });
    const list = make("div", "", poles, { class: "modes" });
    found.modes.forEach((mode, k) => {
      const [re, im] = mode.value, value = `${short(re)}${im ? ` ± ${short(Math.abs(im))}i` : ""}`;
      const button = make("button", `${mode.name}: ${value}`, list, { type: "button", "aria-pressed": "false" });
      const choose = () => {
        list.querySelectorAll("button").forEach((each) => each.setAttribute("aria-pressed", String(each === button)));
        svg.mark(mode.value);
        canvas.setAttribute("aria-label", `Mode ${mode.name}, eigenvalue ${value}, damping ratio ${mode.damping === null ? "none" : short(mode.damping)}`);
        stop();
        stop = swing(canvas, found, mode);
      };
      button.addEventListener("click", choose);
      if (k === 0) choose();
    });
  }
  function map(values) {
    const space = "http://www.w3.org/2000/svg", wide = 320, high = 220, edge = 26;
    const svg = make("svg", "", poles, { viewBox: `0 0 ${wide} ${high}`, role: "img", "aria-label": `${values.length} poles` }, space);
    const re = values.map((v) => v[0]), im = values.map((v) => v[1]);
    const low = Math.min(...re, 0), right = Math.max(...re, 0), span = right - low || 1, top = Math.max(...im.map(Math.abs)) || span;
    const x = (v) => edge + (wide - 2 * edge) * (v - low + 0.05 * span) / (1.1 * span), y = (v) => high / 2 - (high / 2 - edge) * v / top;
    make("line", "", svg, { x1: 0, x2: wide, y1: y(0), y2: y(0) }, space);
    make("line", "", svg, { x1: x(0), x2: x(0), y1: 0, y2: high }, space);
    make("text", `Re ${short(low)} … ${short(right)}`, svg, { x: 4, y: high - 5 }, space);
    make("text", `Im ±${short(top)}`, svg, { x: x(0) + 4 > wide - 70 ? x(0) - 74 : x(0) + 4, y: 12 }, space);
    const dots = values.map(([a, b]) => make("circle", "", svg, { cx: x(a), cy: y(b), r: 3 }, space));
    const size = Math.max(span, top);
    svg.mark = ([a, b]) => values.forEach(([c, d], k) => dots[k].classList.toggle("chosen", Math.hypot(a - c, Math.abs(b) - Math.abs(d)) < 1e-6 * size));
    return svg;
  }
  function swing(canvas, { q, links }, { real, imag, value }) {  // one period, for ever; a mode without a swing goes to and fro
    const n = q.length, m = q[0].length, frames = 48, size = 1 + frames;
    const all = (x) => x.flat(), most = Math.max(...real.map((v, i) => Math.hypot(...v, ...imag[i]))) || 1;
    const lows = q[0].map((_, c) => Math.min(...q.map((x) => x[c]))), spans = q[0].map((_, c) => Math.max(...q.map((x) => x[c])) - lows[c]);
    const far = 0.35 * Math.max(...spans, 1e-9) / Math.max(2, Math.sqrt(n)) / most, turn = value[1] ? -1 : 0;
    const places = all(q), a = all(real), b = all(imag);
    const run = { n, m, t: Float32Array.from({ length: size }, (_, k) => k / frames), q: new Float32Array(size * n * m), p: new Float32Array(size * n * m),
      reach: null, length: null, edges: Float32Array.from(all(links)), edge_counts: [links.length], solids: [], outlines: [], beta: 0, groups: [] };
    for (let k = 0; k < size; k++) {
      const phase = 2 * Math.PI * k / frames, c = Math.cos(phase), s = Math.sin(phase);
      for (let i = 0; i < n * m; i++) {
        run.q[k * n * m + i] = places[i] + far * (a[i] * c + turn * b[i] * s);
        run.p[k * n * m + i] = 2 * Math.PI * far * (-a[i] * s + turn * b[i] * c);
      }
    }
    const drawing = flockanaDrawing(canvas, run), still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    drawing.look.trails = false;
    drawing.palette(); drawing.resize(); drawing.fit();
    drawing.view.scale *= 0.85;
    let asked = 0;
    const step = (now) => { drawing.draw(still ? 0.12 : (now / 2500) % 1); canvas.frames = (canvas.frames || 0) + 1; if (!still) asked = requestAnimationFrame(step); };
    asked = requestAnimationFrame(step);
    const sizes = new ResizeObserver(() => { drawing.resize(); drawing.palette(); if (still) requestAnimationFrame(step); });
    sizes.observe(canvas);
    return () => { cancelAnimationFrame(asked); sizes.disconnect(); };
  }
  return { expect, verdict, spectrum };
}
