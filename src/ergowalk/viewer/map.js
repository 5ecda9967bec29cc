"use strict";

/* The map of a sweep. `map` is the payload of landscape.py; `gaits` has a compressed payload of
   the viewer by key, and `frame` is the page that shows some, with [] where they go. */
function ergowalkMap(root, map, gaits, frame) {
  const find = (name) => root.querySelector("." + name);
  const chart = find("chart"), plane = find("plane"), told = find("told"), walk = find("walk");
  const known = map.energy.filter((e, i) => map.accepted[i]);
  const least = Math.min(...known), most = Math.max(...known);
  const opened = [];
  const planes = [{ x: map.x, y: map.y ?? map.energy, xName: map.x_name, yName: map.y_name || "E [J/m]" }];
  if (map.speed) {
    planes.push({
      x: map.speed, y: map.cadence, speeds: true,
      xName: "walking speed [m/s]", yName: "cadence [steps/min]",
    });
  }
  planes.forEach((p, i) => plane.append(new Option(`${p.yName} over ${p.xName}`, i)));
  find("axes").hidden = planes.length < 2;
  plane.addEventListener("change", draw);
  fillKeys();
  draw();

  function draw() {
    const own = planes[plane.value], place = placed(own);
    chart.replaceChildren();
    const ground = shape("g", { opacity: 0.55 });
    if (map.y) map.triangles.forEach((corners) => ground.append(triangle(own, place, corners)));
    chart.append(ground);
    frameOf(own, place);
    if (map.speed) own.speeds ? people(place) : isolines(place);
    if (map.valley.length) {
      const at = (v, l) => (own.speeds ? [v, (60 * v) / l] : [(2 * l) / v, l]);
      const around = [...map.valley.map((r) => at(r[0], r[4])), ...map.valley.map((r) => at(r[0], r[5])).reverse()];
      chart.append(shape("path", { class: "valley-band", d: path(around, place) + "Z" }));
      const points = map.valley.map(([v, l]) => at(v, l));
      chart.append(shape("path", { class: "valley-line", d: path(points, place) }));
    }
    map.cases.forEach((_, i) => own.y[i] !== null && disc(own, place, i));
  }

  /* From numbers to the place on the chart. */
  function placed(own) {
    const box = { left: 70, right: 880, top: 15, bottom: 505 };
    const range = (values) => {
      const all = values.filter((v) => v !== null), low = Math.min(...all), high = Math.max(...all);
      const room = 0.06 * (high - low || 1);
      return [low - room, high + room];
    };
    const [x0, x1] = range(own.x), [y0, y1] = range(own.y);
    return {
      ...box, x0, x1, y0, y1,
      x: (v) => box.left + ((v - x0) / (x1 - x0)) * (box.right - box.left),
      y: (v) => box.bottom - ((v - y0) / (y1 - y0)) * (box.bottom - box.top),
    };
  }

  function frameOf(own, place) {
    const { left, right, top, bottom } = place;
    chart.append(shape("rect", { class: "frame", x: left, y: top, width: right - left, height: bottom - top }));
    for (const v of ticks(place.x0, place.x1)) {
      const x = place.x(v);
      chart.append(shape("path", { class: "notch", d: `M${x} ${bottom}v6` }));
      label(v, { x, y: bottom + 20, "text-anchor": "middle" });
    }
    for (const v of ticks(place.y0, place.y1)) {
      const y = place.y(v);
      chart.append(shape("path", { class: "notch", d: `M${left} ${y}h-6` }));
      label(v, { x: left - 10, y: y + 4, "text-anchor": "end" });
    }
    label(own.xName, { x: (left + right) / 2, y: bottom + 42, "text-anchor": "middle" });
    const middle = (top + bottom) / 2;
    label(own.yName, { x: 18, y: middle, "text-anchor": "middle", transform: `rotate(-90 18 ${middle})` });
  }

  function triangle(own, place, corners) {
    const mean = corners.reduce((sum, i) => sum + map.energy[i], 0) / 3;
    const points = corners.map((i) => [own.x[i], own.y[i]]);
    const fill = colour(mean);
    return shape("path", { d: path(points, place) + "Z", fill, stroke: fill });
  }

  function isolines(place) {
    for (const v of ticks(Math.min(...map.speed), Math.max(...map.speed))) {
      const points = []; // L = v T / 2
      for (let i = 0; i <= 100; i++) {
        const t = place.x0 + (i / 100) * (place.x1 - place.x0), l = (v * t) / 2;
        if (l > place.y0 && l < place.y1) points.push([t, l]);
      }
      if (points.length < 12) continue;
      chart.append(shape("path", { class: "isoline", d: path(points, place) }));
      const [t, l] = points[points.length - 1];
      label(`${v} m/s`, { class: "small", x: place.x(t) - 3, y: place.y(l) + 13, "text-anchor": "end" });
    }
  }

  function people(place) {
    const within = ([v, c]) => v > place.x0 && v < place.x1 && c > place.y0 && c < place.y1;
    const plain = map.plain.filter(within), inside = map.people.filter(within);
    if (plain.length) chart.append(shape("path", { class: "people-line plain", d: path(plain, place) }));
    if (!inside.length) return;
    const clip = (c) => Math.max(place.y0, Math.min(place.y1, c));
    const upper = inside.map(([v, c, sd]) => [v, clip(c + sd)]);
    const lower = inside.map(([v, c, sd]) => [v, clip(c - sd)]).reverse();
    chart.append(shape("path", { class: "people-band", d: path([...upper, ...lower], place) + "Z" }));
    chart.append(shape("path", { class: "people-line", d: path(inside, place) }));
  }

  function disc(own, place, i) {
    const x = place.x(own.x[i]), y = place.y(own.y[i]), accepted = map.accepted[i];
    const can = map.cases[i].key in gaits;
    const group = shape("g", { class: accepted ? "case" : "case lost", tabindex: 0, role: can ? "button" : "img" });
    group.setAttribute("aria-label", sentence(i));
    const mark = accepted
      ? shape("circle", { cx: x, cy: y, r: 9, fill: colour(map.energy[i]) })
      : shape("path", { d: `M${x - 5} ${y - 5}l10 10m0 -10l-10 10` });
    const title = shape("title", {});
    title.textContent = sentence(i);
    group.append(title, mark);
    if (opened.includes(map.cases[i].key)) group.classList.add("open");
    group.dataset.key = map.cases[i].key;
    for (const name of ["mouseenter", "focus"]) group.addEventListener(name, () => tell(i));
    group.addEventListener("click", (event) => open(i, event.shiftKey || event.ctrlKey || event.metaKey));
    group.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      open(i, event.shiftKey || event.ctrlKey || event.metaKey);
    });
    chart.append(group);
  }

  /* What is known of a case, in words. */
  function sentence(i) {
    const one = map.cases[i], parts = [`${map.x_name}: ${map.x[i]}`];
    if (map.y) parts.push(`${map.y_name}: ${map.y[i]}`);
    if (map.speed) parts.push(`${map.speed[i].toPrecision(3)} m/s, ${map.cadence[i].toPrecision(4)} steps/min`);
    if (map.energy[i] !== null) parts.push(`E = ${map.energy[i].toFixed(2)} J/m`);
    if (one.cost_of_transport !== null) parts.push(`cost of transport ${one.cost_of_transport.toFixed(4)}`);
    if (one.human_distance !== null) parts.push(`${one.human_distance.toFixed(2)} SD from people`);
    parts.push(one.status + (one.reason ? `: ${one.reason}` : ""));
    return parts.join("; ");
  }

  function tell(i) {
    told.textContent = sentence(i) + (map.cases[i].key in gaits ? "" : "; its gait is not in this page");
  }

  async function open(i, more) {
    const key = map.cases[i].key;
    tell(i);
    if (!(key in gaits)) return;
    if (!more) opened.length = 0;
    if (!opened.includes(key)) opened.push(key);
    for (const group of chart.querySelectorAll(".case")) {
      group.classList.toggle("open", opened.includes(group.dataset.key));
    }
    const shown = await Promise.all(opened.map((k) => unpacked(gaits[k])));
    const text = `[${shown.join(",")}]`.replace(/</g, "\\u003c");
    walk.hidden = false;
    walk.srcdoc = frame.replace(">[]<", () => `>${text}<`);
    walk.scrollIntoView({ block: "nearest" });
  }

  function fillKeys() {
    find("low").textContent = least.toFixed(1);
    find("high").textContent = most.toFixed(1) + " J/m";
    const stops = Array.from({ length: 11 }, (_, i) => colour(least + (i / 10) * (most - least)));
    find("ramp").style.background = `linear-gradient(to right, ${stops.join(",")})`;
    find("key-cross").hidden = map.accepted.every((a) => a);
    find("key-valley").hidden = !map.valley.length;
    find("key-people").hidden = !map.people.length;
    find("people-name").textContent = map.people_name;
    find("key-plain").hidden = !map.plain.length;
    find("plain-name").textContent = map.plain_name;
  }

  function colour(energy) {
    const share = most > least ? (energy - least) / (most - least) : 0;
    const at = Math.max(0, Math.min(1, share)) ** (1 / 1.5) * (VIRIDIS.length - 1);
    const i = Math.min(Math.floor(at), VIRIDIS.length - 2);
    const mix = VIRIDIS[i].map((v, k) => Math.round(v + (at - i) * (VIRIDIS[i + 1][k] - v)));
    return `rgb(${mix.join(",")})`;
  }

  function label(text, attributes) {
    const found = shape("text", attributes);
    found.textContent = text;
    chart.append(found);
  }

  function path(points, place) {
    return "M" + points.map(([x, y]) => `${place.x(x).toFixed(1)} ${place.y(y).toFixed(1)}`).join("L");
  }
}

const VIRIDIS = [
  [68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141],
  [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37],
];

function shape(name, attributes) {
  const found = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) found.setAttribute(key, value);
  return found;
}

/* Round numbers between two others, about eight. */
function ticks(low, high) {
  const rough = (high - low) / 8, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((s) => s * power).find((s) => s >= rough);
  const found = [];
  for (let i = Math.ceil(low / step); i * step <= high; i++) found.push(Number((i * step).toPrecision(6)));
  return found;
}

/* The text behind gzip and base64. */
async function unpacked(packed) {
  const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}
