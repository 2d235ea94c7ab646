// Water that flows in joints. A page has this script when its film tells of some.

const FLOW_WIDTHS = [1.6, 2.6, 4, 6]; // Widths of joints by decades of flow below the greatest (px).
const FLOW_PARTS = 16; // Colours along a joint between the least and the greatest pressure head.
const FLOW_ARROWS = 0.1; // Share of the pieces that have an arrow.
const FLOW_APART = 26; // Pixels between two arrows.
const LITRES_PER_MINUTE = 6e4; // In a m³/s.
const DRAIN = "#1b7a4b";
const NO_FLOW = 1e-9; // Share of the greatest flow below which a flow is round-off.
// Blues of ColorBrewer (C. Brewer, Apache 2.0) from shallow to deep, in a white rim that sets them off from blocks.
const DEPTHS = ramp(["c6dbef", "9ecae1", "6baed6", "4292c6", "2171b5", "08519c", "08306b"]);
const RIM = "rgba(255, 255, 255, 0.85)";

const WATER_STYLE = `
  #water-scale .bar { width: 12rem; height: 0.7rem; border-radius: 2px; margin: 0.2rem 0 }
  #water-scale .ends { display: flex; justify-content: space-between; width: 12rem }`;

// The water of a moment: what was noted last before it.
function waterOf(film, time) {
  return film.of("water").findLast((note) => note.time <= time) ?? null;
}

// Shares of a piece between which water stands under pressure, from the places and pressure heads of its ends.
function wetPart([, y0, head0], [, y1, head1]) {
  const heads = [head0, head1],
    upper = y0 < y1 ? 1 : 0;
  if (heads[upper] > 0) return [0, 1];
  const lower = 1 - upper;
  if (!(heads[lower] > 0)) return null;
  const share = Math.min(1, heads[lower] / Math.abs(y1 - y0));
  return lower === 0 ? [0, share] : [1 - share, 1];
}

// Three corners of a block that are far from one line, by which places in it follow its motion.
function frameOfBlock(shape, block) {
  const { x, y } = shape,
    first = block.first;
  let second = first,
    third = first,
    most = 0;
  for (let c = first; c < block.end; c++) {
    const far = Math.hypot(x[c] - x[first], y[c] - y[first]);
    if (far > most) [second, most] = [c, far];
  }
  most = 0;
  for (let c = first; c < block.end; c++) {
    const area = (x[second] - x[first]) * (y[c] - y[first]) - (y[second] - y[first]) * (x[c] - x[first]);
    if (Math.abs(area) > Math.abs(most)) [third, most] = [c, area];
  }
  return { corners: [first, second, third], area: most };
}

// The pixel at which a place of the reference configuration is drawn that moves with a block.
function drawnAt(slope, k, placeX, placeY) {
  const { shape } = slope.film,
    block = shape.blocks[k];
  const { corners, area } = (block.frame ??= frameOfBlock(shape, block));
  const [a, b, c] = corners,
    [atX, atY] = [placeX - shape.originX - shape.x[a], placeY - shape.originY - shape.y[a]];
  const cross = (ux, uy, vx, vy) => (area ? (ux * vy - uy * vx) / area : 0);
  const second = cross(atX, atY, shape.x[c] - shape.x[a], shape.y[c] - shape.y[a]),
    third = cross(shape.x[b] - shape.x[a], shape.y[b] - shape.y[a], atX, atY);
  const now = (values) => values[a] + second * (values[b] - values[a]) + third * (values[c] - values[a]);
  return slope.toScreen(now(slope.x), now(slope.y));
}

// Measures of a note that no frame changes.
function measuresOf(note) {
  if (note.measures) return note.measures;
  const flows = note.pieces.map(([, , , flow]) => Math.abs(flow)),
    greatest = Math.max(0, ...flows);
  const moving = flows.filter((flow) => flow > 0).sort((a, b) => b - a);
  const least = moving[Math.floor(FLOW_ARROWS * moving.length)] ?? Infinity;
  return (note.measures = { greatest, least, deepest: Math.max(0, ...note.nodes.map(([, , head]) => head)) });
}

function widthOfFlow(flow, greatest) {
  const decades = flow > 0 ? Math.floor(-Math.log10(flow / greatest)) : Infinity;
  return FLOW_WIDTHS[FLOW_WIDTHS.length - 1 - Math.min(Math.max(decades, 0), FLOW_WIDTHS.length - 1)];
}

// Draws the joints of a note over the blocks: wet parts in the colours of their pressure heads, the rest thin.
function drawFlow(slope, note, theme) {
  const { pen } = slope,
    { greatest, least, deepest } = measuresOf(note),
    taken = new Set(),
    arrows = [],
    tables = [];
  const colours = DEPTHS,
    places = slope.film.shape.places;
  for (const [from, to, block, flow] of note.pieces) {
    const k = places.get(block);
    if (k === undefined) continue;
    const [a, b] = [note.nodes[from], note.nodes[to]],
      ends = [drawnAt(slope, k, a[0], a[1]), drawnAt(slope, k, b[0], b[1])];
    const at = (share) => [0, 1].map((axis) => ends[0][axis] + share * (ends[1][axis] - ends[0][axis]));
    strokeLine(pen, at(0), at(1), theme.soft, 1.2);
    const wet = wetPart(a, b);
    if (wet) {
      const width = widthOfFlow(Math.abs(flow), greatest);
      strokeLine(pen, at(wet[0]), at(wet[1]), RIM, width + 2);
      const heads = [wet[0] > 0 ? 0 : a[2], wet[1] < 1 ? 0 : b[2]],
        parts = Math.max(1, Math.ceil((FLOW_PARTS * Math.abs(heads[1] - heads[0])) / (deepest || 1)));
      for (let part = 0; part < parts; part++) {
        const head = heads[0] + ((heads[1] - heads[0]) * (part + 0.5)) / parts,
          step = Math.min(colours.length - 1, Math.floor((colours.length * head) / (deepest || 1)));
        const [start, end] = [part, part + 1].map((p) => at(wet[0] + ((wet[1] - wet[0]) * p) / parts));
        strokeLine(pen, start, end, colours[step], width);
      }
      const table = wet.find((share) => share > 0 && share < 1);
      if (table !== undefined) tables.push(at(table));
    }
    if (flow !== 0 && Math.abs(flow) >= least) arrows.push([Math.abs(flow), flow > 0 ? ends : [ends[1], ends[0]]]);
  }
  for (const [x, y] of tables) strokeLine(pen, [x - 6, y], [x + 6, y], theme.water, 2.4);
  for (const [, ends] of arrows.sort((a, b) => b[0] - a[0])) drawFlowArrow(slope, ends, taken, theme);
  note.seeps.forEach(([x, y]) => drawSeep(slope, x, y, theme));
  note.drains.forEach((drain) => drawDrain(slope, drain, theme));
}

function strokeLine(pen, from, to, colour, width) {
  pen.beginPath();
  pen.moveTo(...from);
  pen.lineTo(...to);
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.stroke();
}

function drawFlowArrow({ pen }, [from, to], taken, theme) {
  const middle = [0, 1].map((axis) => 0.5 * (from[axis] + to[axis])),
    cell = middle.map((place) => Math.floor(place / FLOW_APART)).join(" ");
  const long = Math.hypot(to[0] - from[0], to[1] - from[1]);
  if (!long || taken.has(cell)) return;
  taken.add(cell);
  const [ux, uy] = [(to[0] - from[0]) / long, (to[1] - from[1]) / long];
  const at = (along, across) => [middle[0] + along * ux - across * uy, middle[1] + along * uy + across * ux];
  for (const [colour, width] of [[theme.halo, 4], [theme.ink, 1.8]]) {
    strokeLine(pen, at(-9, 0), at(9, 0), colour, width);
    strokeLine(pen, at(3, 4), at(9, 0), colour, width);
    strokeLine(pen, at(3, -4), at(9, 0), colour, width);
  }
}

// A triangle at an outcrop through which water seeps.
function drawSeep(slope, placeX, placeY, theme) {
  const { pen } = slope,
    { originX, originY } = slope.film.shape,
    [x, y] = slope.toScreen(placeX - originX, placeY - originY);
  pen.beginPath();
  pen.moveTo(x, y - 6);
  pen.lineTo(x + 5, y + 3.5);
  pen.lineTo(x - 5, y + 3.5);
  pen.closePath();
  pen.fillStyle = theme.water;
  pen.fill();
  pen.strokeStyle = theme.ink;
  pen.lineWidth = 1;
  pen.stroke();
}

function drawDrain(slope, { name, points, flow }, theme) {
  const { originX, originY } = slope.film.shape;
  const line = points.map(([x, y]) => slope.toScreen(x - originX, y - originY));
  for (let k = 1; k < line.length; k++) {
    strokeLine(slope.pen, line[k - 1], line[k], theme.halo, 5.5);
    strokeLine(slope.pen, line[k - 1], line[k], DRAIN, 2.6);
  }
  write(slope, `${name} ${litres(flow)} L/min`, line[0][0] + 7, line[0][1] + 14, theme.ink, theme);
}

// A flow (m²/s) in litres per minute and metre of depth.
function litres(flow) {
  return digits(flow * LITRES_PER_MINUTE).replace("-", "−");
}

// Water that enters and leaves at each place in the stage of now.
function waterTable(note) {
  const { greatest, deepest } = measuresOf(note);
  const shown = note.inlets.filter((inlet) => Math.max(inlet.enters, inlet.leaves, inlet.runs_off) > NO_FLOW * greatest);
  const rows = shown.map(({ name, enters, leaves, runs_off }) =>
    element(
      "tr",
      {},
      element("td", { class: "text" }, name),
      ...[enters, leaves, runs_off].map((flow) => element("td", { title: `${flow} m²/s` }, litres(flow))),
    ),
  );
  return [
    element("p", { class: "soft" }, `Found at the start of stage ${note.stage}; L/min per metre of depth.`),
    headed("inlets", 1, ["Place", "In", "Out", "Runs off"], rows),
    table([
      ["Greatest pressure head", withUnit(deepest, "m")],
      ["Greatest flow in a joint", `${litres(greatest)} L/min`],
      ["Outcrops that seep", String(note.seeps.length)],
    ]),
  ];
}

// The layer: a section of the panel with its switch, and the drawing over the blocks.
const water = { shown: true, note: null };

function waterSection(viewer) {
  const input = element("input", { id: "water", type: "checkbox", checked: water.shown });
  input.addEventListener("change", () => {
    water.shown = input.checked;
    viewer.refresh();
  });
  const made = section(
    "Water in joints",
    element("style", {}, WATER_STYLE),
    element("label", {}, input, "Water"),
    element("div", { id: "water-scale" }),
    element(
      "p",
      { class: "soft" },
      "Joints by pressure head, thin where there is none, the wider the more water flows (each width a decade); " +
        "arrows along the tenth in which most flows, dashes at water tables, △ outcrops that seep, green lines drains.",
    ),
    element("div", { id: "water-now" }),
  );
  made.id = "water-section";
  return made;
}

function showWater(note) {
  water.note = note;
  if (!note) return by("water-now").replaceChildren(element("p", {}, "No water flows yet."));
  by("water-now").replaceChildren(...waterTable(note));
  const bar = element("div", { class: "bar" });
  bar.style.background = `linear-gradient(to right, ${DEPTHS.join(", ")})`;
  const end = (head) => element("span", {}, digits(head));
  by("water-scale").replaceChildren(
    "Pressure head (m)",
    bar,
    element("div", { class: "ends" }, end(0), end(measuresOf(note).deepest)),
  );
}

const drawWithoutFlow = Slope.prototype.draw;
Slope.prototype.draw = function draw(frame, paint, over, theme) {
  drawWithoutFlow.call(this, frame, paint, over, theme);
  const note = waterOf(this.film, frame.time);
  if (note && water.shown) drawFlow(this, note, theme);
  if (note !== water.note && by("water-now")) showWater(note);
};

const buildWithoutFlow = Viewer.prototype.buildPanel;
Viewer.prototype.buildPanel = function buildPanel() {
  buildWithoutFlow.call(this);
  if (!this.film.of("water").length) return;
  by("choice").after(waterSection(this));
  showWater(waterOf(this.film, this.player.time));
};
