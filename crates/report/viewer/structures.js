// What acts on the rock beside its joints: water, supports, bolts with their tension.

// Bits of the sign of a support.
const HELD_X = 1,
  HELD_Y = 2,
  ABSORBS = 4;
const YIELDED = 2,
  BROKEN = 3;
const APART = 15; // Pixels between two signs of supports.
const WET_CLASSES = 4; // Widths of lines that show the pressure of water.
const SHALLOW = 1e-4; // Depth over the size of the model below which water does not count: places are singles.

// Whether a film has anything of this kind.
function hasStructures(film) {
  const has = ({ bolts, supports, water }) => bolts.state.some(Boolean) || supports.sign.length || water.x.length;
  return film.frames.some(has);
}

// Bolts now: name, ends as they are drawn, tension, state; those that are not there left out.
function boltsNow(film, { from, to, part }, base, magnification) {
  const { originX, originY } = film.shape,
    a = film.frames[from].bolts,
    b = film.frames[to].bolts,
    start = base === null ? null : film.frames[base].bolts;
  const end = ([x, y], ux, uy, k) => {
    const now = (key) => {
      const at = start ? start[key][k] : 0;
      return at + magnification * (a[key][k] + (b[key][k] - a[key][k]) * part - at);
    };
    return [x - originX + now(ux), y - originY + now(uy)];
  };
  return film.head.bolts
    .map(({ name, ends }, k) => ({
      name,
      ends: [end(ends[0], "ux0", "uy0", k), end(ends[1], "ux1", "uy1", k)],
      force: a.force[k],
      state: a.state[k],
    }))
    .filter(({ state }) => state > 0);
}

// Height (m) of the water at a place (m): level beyond the ends of its surface.
function waterAt({ x, y }, at) {
  const after = x.findIndex((place) => place > at);
  if (after === 0) return y[0];
  if (after < 0) return y[y.length - 1];
  return y[after - 1] + ((y[after] - y[after - 1]) * (at - x[after - 1])) / (x[after] - x[after - 1]);
}

// Draws water, supports and bolts of a frame over the blocks.
function drawStructures(slope, frame, bolts, theme) {
  if (frame.water.x.length) drawWater(slope, frame, theme);
  drawSupports(slope, frame.supports, theme);
  drawBolts(slope, bolts, theme);
}

function drawWater(slope, frame, theme) {
  const { pen } = slope,
    { water } = frame,
    { west, east } = slope.view;
  const line = [[west, waterAt(water, west)]];
  for (let k = 0; k < water.x.length; k++) {
    if (water.x[k] > west && water.x[k] < east) line.push([water.x[k], water.y[k]]);
  }
  line.push([east, waterAt(water, east)]);
  const most = frame.wet ? drawPressure(slope, frame, theme) : 0;
  pen.beginPath();
  line.forEach(([x, y], k) => (k ? pen.lineTo(...slope.toScreen(x, y)) : pen.moveTo(...slope.toScreen(x, y))));
  pen.strokeStyle = theme.halo;
  pen.lineWidth = 4.5;
  pen.stroke();
  pen.strokeStyle = theme.water;
  pen.lineWidth = 2;
  pen.stroke();
  const [px, py] = slope.toScreen(west, waterAt(water, west + 30 / slope.camera.scale));
  pen.beginPath();
  pen.moveTo(px + 24, py - 11);
  pen.lineTo(px + 36, py - 11);
  pen.lineTo(px + 30, py - 1);
  pen.closePath();
  pen.stroke();
  const text = most > 0 ? `water, up to ${withUnit(most, "Pa")}` : "water";
  write(slope, text, px + 42, py - 5, theme.water, theme);
}

// Lines along the edges on which water presses, the wider the greater the pressure; returns the greatest (Pa).
function drawPressure(slope, frame, theme) {
  const { pen, film, x, y } = slope,
    edges = [];
  // Displacements that are drawn larger than they are count for nothing here.
  const [trueX, trueY] = slope.magnification === 1 ? [x, y] : [film.shape.x, film.shape.y];
  const depth = (at) => Math.max(0, waterAt(frame.water, trueX[at]) - trueY[at]);
  let most = 0;
  film.shape.blocks.forEach((block, k) => {
    if (frame.removed[k]) return;
    for (const [first, end] of block.loops) {
      for (let c = first; c < end; c++) {
        if (!frame.wet[c]) continue;
        const next = c + 1 < end ? c + 1 : first;
        most = Math.max(most, frame.water.weight * Math.max(depth(c), depth(next)));
        edges.push([c, next, 0.5 * frame.water.weight * (depth(c) + depth(next))]);
      }
    }
  });
  if (most < SHALLOW * film.shape.size * frame.water.weight) return 0;
  pen.strokeStyle = theme.water;
  pen.globalAlpha = 0.75;
  for (let level = 1; level <= WET_CLASSES; level++) {
    pen.lineWidth = 1 + 1.5 * level;
    pen.beginPath();
    for (const [from, to, pressure] of edges) {
      if (pressure <= 0 || Math.ceil((WET_CLASSES * pressure) / most) !== level) continue;
      pen.moveTo(...slope.toScreen(x[from], y[from]));
      pen.lineTo(...slope.toScreen(x[to], y[to]));
    }
    pen.stroke();
  }
  pen.globalAlpha = 1;
  return most;
}

// A triangle where rock is held, a circle where it is held along one axis, a square on a boundary that lets waves out.
function drawSupports(slope, { sign, x, y }, theme) {
  const { pen } = slope,
    taken = new Set();
  pen.lineWidth = 1.5;
  pen.strokeStyle = theme.ink;
  pen.fillStyle = theme.paper;
  for (let k = 0; k < sign.length; k++) {
    const [px, py] = slope.toScreen(x[k], y[k]),
      cell = `${Math.round(px / APART)} ${Math.round(py / APART)} ${sign[k]}`;
    if (taken.has(cell)) continue;
    taken.add(cell);
    pen.beginPath();
    if (sign[k] & ABSORBS) pen.rect(px - 3.5, py - 3.5, 7, 7);
    else if (sign[k] === (HELD_X | HELD_Y)) {
      pen.moveTo(px, py);
      pen.lineTo(px - 5, py + 9);
      pen.lineTo(px + 5, py + 9);
      pen.closePath();
    } else pen.arc(px, py, 4, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
  }
}

// Bolts, and beside each the tension of its length that bears most.
function drawBolts(slope, bolts, theme) {
  const { pen } = slope,
    most = new Map();
  for (const bolt of bolts) {
    const ends = bolt.ends.map(([x, y]) => slope.toScreen(x, y));
    pen.beginPath();
    pen.moveTo(...ends[0]);
    pen.lineTo(...ends[1]);
    pen.setLineDash(bolt.state === BROKEN ? [4, 4] : []);
    pen.strokeStyle = theme.halo;
    pen.lineWidth = 6;
    pen.stroke();
    pen.strokeStyle = theme.bolt;
    pen.lineWidth = bolt.state === YIELDED ? 4.5 : 2.5;
    pen.stroke();
    pen.setLineDash([]);
    const [head, tail] = ends,
      long = Math.hypot(tail[0] - head[0], tail[1] - head[1]) || 1;
    const across = [(-5 * (tail[1] - head[1])) / long, (5 * (tail[0] - head[0])) / long];
    pen.beginPath();
    pen.moveTo(head[0] - across[0], head[1] - across[1]);
    pen.lineTo(head[0] + across[0], head[1] + across[1]);
    pen.lineWidth = 2.5;
    pen.stroke();
    const before = most.get(bolt.name);
    if (!before || bolt.force > before.force) most.set(bolt.name, { ...bolt, tail });
  }
  for (const { name, force, state, tail } of most.values()) {
    const end = state === BROKEN ? " broken" : state === YIELDED ? " yields" : "";
    write(slope, `${name} ${withUnit(force, "N/m")}${end}`, tail[0] + 7, tail[1] + 4, theme.ink, theme);
  }
}

// A small text with a halo.
function write(slope, text, px, py, colour, theme) {
  const { pen } = slope;
  pen.font = "600 12px system-ui, sans-serif";
  pen.lineWidth = 3.5;
  pen.lineJoin = "round";
  pen.strokeStyle = theme.halo;
  pen.strokeText(text, px, py);
  pen.fillStyle = colour;
  pen.fillText(text, px, py);
}
