"use strict";
(() => {
  const all = (where, what) => [...where.querySelectorAll(what)];

  // Light and dark: the reader's choice outlives the visit where it can be kept.
  const root = document.documentElement;
  const dark = () => (root.dataset.theme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  try { if (localStorage.theme) root.dataset.theme = localStorage.theme; } catch { /* nothing can be kept */ }
  document.getElementById("theme").addEventListener("click", () => {
    root.dataset.theme = dark() ? "light" : "dark";
    try { localStorage.theme = root.dataset.theme; } catch { /* nothing can be kept */ }
  });

  for (const button of all(document, ".copy")) {
    button.addEventListener("click", async () => {
      try { await navigator.clipboard.writeText(button.previousElementSibling.textContent); button.textContent = "copied"; }
      catch { getSelection().selectAllChildren(button.previousElementSibling); }
    });
  }
  addEventListener("beforeprint", () => { for (const one of all(document, "details")) one.open = true; });

  // Tables: a click on a column's name sorts, by numbers where there are some, empty cells last; words filter rows.
  const order = (row, place) => {
    const cell = row.cells[place];
    return "order" in cell.dataset ? Number(cell.dataset.order) : cell.textContent.trim();
  };
  const compare = (one, other) => typeof one === typeof other
    ? (typeof one === "number" ? one - other : one.localeCompare(other, "en", { numeric: true }))
    : (typeof one === "number" ? -1 : 1);
  const sort = (table, place) => {
    const heads = all(table, "th"), up = heads[place].getAttribute("aria-sort") !== "ascending";
    heads.forEach((head, i) => head.setAttribute("aria-sort", i === place ? (up ? "ascending" : "descending") : "none"));
    const rows = [...table.tBodies[0].rows].map(row => [order(row, place), row]);
    const empty = rows.filter(([key]) => key === ""), known = rows.filter(([key]) => key !== "");
    known.sort(([one], [other]) => (up ? 1 : -1) * compare(one, other));
    table.tBodies[0].append(...[...known, ...empty].map(([, row]) => row));
  };
  for (const listing of all(document, ".listing")) {
    const table = listing.querySelector("table"), count = listing.querySelector("output");
    all(table, "th button").forEach((button, place) => button.addEventListener("click", () => sort(table, place)));
    listing.querySelector("input").addEventListener("input", event => {
      const words = event.target.value.toLowerCase().split(/\s+/).filter(Boolean);
      let shown = 0;
      for (const row of table.tBodies[0].rows) {
        const text = row.textContent.toLowerCase();
        row.hidden = !words.every(word => text.includes(word));
        shown += !row.hidden;
      }
      count.textContent = `${shown} row${shown === 1 ? "" : "s"}`;
    });
  }

  // Force histories.
  const BAND = 0.02;  // of the height: a band that is narrower is drawn magnified
  const NS = "http://www.w3.org/2000/svg";
  const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];
  const prefixed = (largest, unit) => {
    const [size, name] = PREFIXES.find(([one]) => largest >= one) || PREFIXES[3];
    return { size, unit: name + unit };
  };
  const element = (name, attributes, parent) => {
    const made = document.createElementNS(NS, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    parent?.append(made);
    return made;
  };
  const ticks = (low, high, most) => {
    const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map(one => one * power).find(one => one >= rough);
    const found = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) found.push(i * step);
    return found;
  };
  const plain = value => String(Number(value.toPrecision(10)));
  const at = (curve, column, time) => {  // on the straight line between two rows, zero outside them
    const t = curve.time;
    if (time < t[0] || time > t[t.length - 1]) return 0;
    let low = 0, high = t.length - 1;
    while (high - low > 1) { const middle = (low + high) >> 1; if (t[middle] <= time) low = middle; else high = middle; }
    const width = t[high] - t[low], share = width > 0 ? (time - t[low]) / width : 1;
    return curve[column][low] + share * (curve[column][high] - curve[column][low]);
  };
  const spelled = name => name === "fe" ? "finite elements" : name.replaceAll("_", " ");

  for (const box of all(document, ".histories")) {
    const script = box.querySelector("script"), scenes = JSON.parse(script.textContent);
    const select = box.querySelector(".scene"), plot = box.querySelector(".plot"), svg = box.querySelector(".chart");
    const switches = box.querySelector(".curves"), readout = box.querySelector(".readout"), files = box.querySelector(".csv"), magnified = box.querySelector(".magnified");
    const margin = { left: 52, right: 14, top: 22, bottom: 40 };
    let curves = [], span = [0, 1], whole = [0, 1], cursor = null, drag = null, scale = null;

    const choose = name => {
      select.value = name;
      for (const one of all(box, ".gallery button")) one.setAttribute("aria-pressed", one.dataset.scene === name);
      const asked = new Map(curves.map(one => [one.name, one.shown]));
      const { exact } = scenes[name];
      curves = Object.entries(scenes[name].curves).map(([key, curve], place) => (
        { ...curve, name: key, said: spelled(key) + (key === exact ? " (exact)" : ""), look: place, dashed: key === exact,
          shown: place === 0 || key === exact || asked.get(key) === true }));
      switches.replaceChildren(switches.firstElementChild, ...curves.map(curve => {
        const label = document.createElement("label"), input = document.createElement("input"), sign = document.createElement("i");
        input.type = "checkbox"; input.checked = curve.shown;
        input.addEventListener("change", () => { curve.shown = input.checked; draw(); });
        sign.className = `k${curve.look}${curve.dashed ? " dashed" : ""}`;
        label.append(input, sign, curve.said);
        return label;
      }));
      whole = [Math.min(...curves.map(one => one.time[0])), Math.max(...curves.filter(one => one.shown).map(one => one.time[one.time.length - 1]))];
      span = [...whole]; cursor = null;
      files.replaceChildren("CSV: ", ...curves.map(curve => {
        const link = document.createElement("a");
        link.href = `${script.dataset.files}${name}-${curve.name}.csv`;
        link.textContent = spelled(curve.name);
        return link;
      }));
      draw();
    };

    const draw = () => {
      const width = Math.max(plot.clientWidth, 260), height = Math.round(Math.min(420, Math.max(230, 0.48 * width)));
      svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
      svg.replaceChildren();
      const shown = curves.filter(one => one.shown);
      const inside = shown.flatMap(one => [...one.force.filter((_, i) => one.time[i] >= span[0] && one.time[i] <= span[1]),
        at(one, "force", span[0]), at(one, "force", span[1])]);
      const high = Math.max(...inside, 1e-300), low = Math.min(...inside, 0);
      // The band is drawn magnified by a power of ten, and the axis reaches as far as it does.
      const widest = Math.max(...shown.map(one => Math.max(...one.error)));
      const bottom = low < 0 ? low - 0.06 * (high - low) : 0, bare = high + 0.06 * (high - low);
      const times = widest > 0 ? Math.max(1, 10 ** Math.ceil(Math.log10(BAND * (bare - bottom) / widest))) : 1;
      const within = one => one.force.map((force, i) => force + times * one.error[i]).filter((_, i) => one.time[i] >= span[0] && one.time[i] <= span[1]);
      const top = Math.max(bare, ...shown.flatMap(within));
      const x = time => margin.left + (time - span[0]) / (span[1] - span[0]) * (width - margin.left - margin.right);
      const y = force => height - margin.bottom - (force - bottom) / (top - bottom) * (height - margin.top - margin.bottom);
      const back = place => span[0] + (place - margin.left) / (width - margin.left - margin.right) * (span[1] - span[0]);
      const second = prefixed(Math.max(Math.abs(span[0]), Math.abs(span[1])), "s"), newton = prefixed(high, "N");
      scale = { x, y, back, width, height, second, newton };
      for (const one of ticks(span[0] / second.size, span[1] / second.size, Math.max(3, width / 110))) {
        const place = x(one * second.size);
        element("line", { x1: place, x2: place, y1: margin.top, y2: height - margin.bottom, class: "grid" }, svg);
        element("text", { x: place, y: height - margin.bottom + 17, "text-anchor": "middle" }, svg).textContent = plain(one);
      }
      for (const one of ticks(bottom / newton.size, top / newton.size, Math.max(3, height / 70))) {
        const place = y(one * newton.size);
        element("line", { x1: margin.left, x2: width - margin.right, y1: place, y2: place, class: "grid" }, svg);
        element("text", { x: margin.left - 7, y: place + 4, "text-anchor": "end" }, svg).textContent = plain(one);
      }
      element("text", { x: width - margin.right, y: height - 6, "text-anchor": "end" }, svg).textContent = `time, ${second.unit}`;
      element("text", { x: 4, y: 13 }, svg).textContent = `force, ${newton.unit}`;
      const clip = element("clipPath", { id: "inside" }, svg);
      element("rect", { x: margin.left, y: margin.top, width: width - margin.left - margin.right, height: height - margin.top - margin.bottom }, clip);
      const inner = element("g", { "clip-path": "url(#inside)" }, svg);
      magnified.textContent = times > 1 ? `Shaded: the error band, drawn ${times} times as wide.` : "Shaded: the error band.";
      for (const curve of shown) {
        const path = (times, forces) => times.map((time, i) => `${x(time).toFixed(1)} ${y(forces[i]).toFixed(1)}`);
        const upper = path(curve.time, curve.force.map((force, i) => force + times * curve.error[i]));
        const lower = path(curve.time, curve.force.map((force, i) => force - times * curve.error[i])).reverse();
        element("path", { d: `M${upper.join("L")}L${lower.join("L")}Z`, class: `band k${curve.look}` }, inner);
        element("path", { d: `M${path(curve.time, curve.force).join("L")}`, class: `curve k${curve.look}${curve.dashed ? " dashed" : ""}` }, inner);
      }
      if (drag) {
        const [left, right] = [x(drag[0]), x(drag[1])].sort((a, b) => a - b);
        element("rect", { x: left, width: right - left, y: margin.top, height: height - margin.top - margin.bottom, class: "drag" }, inner);
      }
      tell(shown, inner);
    };

    const tell = (shown, inner) => {
      if (cursor === null) { readout.textContent = "Point at the curve, or move the cursor with the arrow keys, to read values off."; return; }
      element("line", { x1: scale.x(cursor), x2: scale.x(cursor), y1: margin.top, y2: scale.height - margin.bottom, class: "cursor" }, inner);
      const time = document.createElement("span");
      time.textContent = `t = ${(cursor / scale.second.size).toPrecision(4)} ${scale.second.unit}`;
      readout.replaceChildren(time, ...shown.map(curve => {
        const force = at(curve, "force", cursor), error = at(curve, "error", cursor), said = document.createElement("span");
        element("circle", { cx: scale.x(cursor), cy: scale.y(force), r: 3.5, class: `dot k${curve.look}` }, inner);
        const name = document.createElement("b");
        name.textContent = curve.said;
        const bar = error / scale.newton.size;
        said.append(name, ` ${(force / scale.newton.size).toPrecision(5)} ± ${bar.toPrecision(2)} ${scale.newton.unit}`);
        return said;
      }));
    };

    const zoom = factor => {
      const middle = cursor ?? (span[0] + span[1]) / 2, share = (middle - span[0]) / (span[1] - span[0]);
      const width = Math.min((span[1] - span[0]) * factor, whole[1] - whole[0]) || whole[1] - whole[0];
      const start = factor === 0 ? whole[0] : Math.min(Math.max(middle - share * width, whole[0]), whole[1] - width);
      if (width > 1e-9 * (whole[1] - whole[0])) span = [start, start + width];
      draw();
    };
    const timeOf = event => {
      const frame = svg.getBoundingClientRect();
      return Math.min(Math.max(scale.back((event.clientX - frame.left) * scale.width / frame.width), span[0]), span[1]);
    };
    svg.addEventListener("pointermove", event => { cursor = timeOf(event); if (drag) drag[1] = cursor; draw(); });
    svg.addEventListener("pointerdown", event => { if (event.pointerType !== "touch") { drag = [timeOf(event), timeOf(event)]; svg.setPointerCapture(event.pointerId); } cursor = timeOf(event); draw(); });
    svg.addEventListener("pointerup", () => {
      if (drag && Math.abs(drag[1] - drag[0]) > 0.02 * (span[1] - span[0])) span = [Math.min(...drag), Math.max(...drag)];
      drag = null; draw();
    });
    svg.addEventListener("pointerleave", () => { if (!drag) { cursor = null; draw(); } });
    svg.addEventListener("wheel", event => { if (event.ctrlKey) { event.preventDefault(); zoom(event.deltaY > 0 ? 1.25 : 0.8); } }, { passive: false });
    plot.addEventListener("keydown", event => {
      const step = (span[1] - span[0]) / 100;
      const keys = { ArrowLeft: -step, ArrowRight: step };
      if (event.key in keys) cursor = Math.min(Math.max((cursor ?? span[0]) + keys[event.key], span[0]), span[1]);
      else if (event.key === "+" || event.key === "=") { zoom(0.5); }
      else if (event.key === "-") { zoom(2); }
      else if (event.key === "Escape") { cursor = null; zoom(0); }
      else return;
      event.preventDefault(); draw();
    });
    for (const button of all(box, ".zoom button")) button.addEventListener("click", () => zoom(Number(button.dataset.zoom)));
    for (const button of all(box, ".gallery button")) button.addEventListener("click", () => choose(button.dataset.scene));
    select.addEventListener("change", () => choose(select.value));
    new ResizeObserver(() => draw()).observe(plot);
    choose(box.dataset.start in scenes ? box.dataset.start : select.value);
  }
})();
