// Series of a run below its drawing, with a cursor at the time that is shown.
const SVG = "http://www.w3.org/2000/svg";

function flockanaStrip(place, run, seek) {
  const t = run.series_t, first = t[0], span = t[t.length - 1] - t[0] || 1, rows = [];
  const x = (time) => 1000 * (time - first) / span;
  const make = (kind, attributes, parent) => {
    const node = document.createElementNS(SVG, kind);
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    if (parent) parent.append(node);
    return node;
  };
  run.series.forEach(({ label, log }, k) => {
    const values = Array.from(run[`series_${k}`]);
    const positive = values.filter((v) => v > 0), logarithmic = log && positive.length > 0;
    const least = logarithmic ? Math.log10(Math.min(...positive)) : 0;
    const scaled = logarithmic ? values.map((v) => (v > 0 ? Math.log10(v) : least)) : values;
    const low = Math.min(...scaled), high = Math.max(...scaled), flat = !(high > low);
    const row = document.createElement("div"), name = document.createElement("span"), value = document.createElement("output");
    row.className = "fp-row"; name.textContent = label + (logarithmic ? ", log" : "");
    const graph = make("svg", { viewBox: "0 0 1000 40", preserveAspectRatio: "none", "aria-hidden": "true" });
    const y = (v) => (flat ? 20 : 37 - 34 * (v - low) / (high - low));
    make("polyline", { points: scaled.map((v, i) => `${x(t[i]).toFixed(1)},${y(v).toFixed(1)}`).join(" ") }, graph);
    const cursor = make("line", { x1: 0, x2: 0, y1: 0, y2: 40, class: "fp-cursor" }, graph);
    row.append(name, graph, value);
    place.append(row);
    const at = (event) => {
      const box = graph.getBoundingClientRect();
      seek(first + span * Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)));
    };
    graph.addEventListener("pointerdown", (event) => { graph.setPointerCapture(event.pointerId); at(event); });
    graph.addEventListener("pointermove", (event) => { if (event.buttons) at(event); });
    rows.push({ label, values, graph, cursor, value });
  });
  const marked = new Map();
  const list = document.createElement("div");
  list.className = "fp-marks";
  function mark(marks) {  // instants with their names, as buttons in order of time; of one time once
    for (const { t: time, label } of marks) {
      const known = marked.get(time);
      const names = known && known !== label ? `${known}, ${label}` : label;
      if (!known) for (const { graph, cursor } of rows) {
        const line = make("line", { x1: x(time), x2: x(time), y1: 0, y2: 40, class: "fp-mark" });
        make("title", {}, line).textContent = label;
        graph.insertBefore(line, cursor);
      }
      marked.set(time, names);
    }
    if (!marked.size) return;
    list.replaceChildren("Instants: ");
    for (const [time, label] of [...marked].sort((a, b) => a[0] - b[0])) {
      const button = document.createElement("button");
      button.type = "button"; button.textContent = `t = ${Number(time.toPrecision(4))}: ${label}`;
      button.addEventListener("click", () => seek(time));
      list.append(button);
    }
    if (!list.parentNode) place.append(list);
  }
  mark(run.marks);
  function value(values, time) {  // of the nearest sample: between samples nothing is known
    let low = 0, high = t.length - 1;
    while (high - low > 1) { const k = (low + high) >> 1; if (t[k] <= time) low = k; else high = k; }
    return values[time - t[low] <= t[high] - time ? low : high];
  }
  function show(time) {
    for (const row of rows) {
      const now = value(row.values, time).toPrecision(4);
      row.cursor.setAttribute("x1", x(time)); row.cursor.setAttribute("x2", x(time));
      row.value.textContent = String(Number(now));
    }
  }
  const words = (time) => rows.slice(0, 2).map((row) => `${row.label} ${Number(value(row.values, time).toPrecision(3))}`).join(", ");
  return { show, words, mark };
}
