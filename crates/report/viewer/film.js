// The film: bytes to typed arrays. `format.md` of the crate has the layout.

const MAGIC = "enmmfil6";
const CHUNK_HEADER = 16;
// Vectors and tensors among the numbers of blocks; the page shows all others one by one.
const PARTS = {
  displacement: ["displacement_x", "displacement_y"],
  velocity: ["velocity_x", "velocity_y"],
  stress: ["mean_stress_xx", "mean_stress_yy", "mean_stress_xy"],
};
const OWN_ROWS = new Set(["rotation", "angular_velocity", ...Object.values(PARTS).flat()]);
// Numbers of a bolt in a frame, with the bytes that each takes.
const BOLT_NUMBERS = [
  ["ux0", 4],
  ["uy0", 4],
  ["ux1", 4],
  ["uy1", 4],
  ["force", 3],
];
const WET = 8; // Bit of the state of an edge on which water presses.
const OPEN = 1,
  SLIP = 2,
  LOCK = 3,
  BRIDGE = 4,
  BROKEN_BRIDGE = 5;

// Reads numbers one after the other.
class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.at = 0;
  }
  u8() {
    return this.bytes[this.at++];
  }
  u16() {
    this.at += 2;
    return this.view.getUint16(this.at - 2, true);
  }
  u32() {
    this.at += 4;
    return this.view.getUint32(this.at - 4, true);
  }
  f32() {
    this.at += 4;
    return this.view.getFloat32(this.at - 4, true);
  }
  f64() {
    this.at += 8;
    return this.view.getFloat64(this.at - 8, true);
  }
  take(count) {
    this.at += count;
    return this.bytes.subarray(this.at - count, this.at);
  }
  // Singles whose bytes of one weight stand side by side; missing low bytes are zero.
  planes(count, width) {
    const out = new Float32Array(count),
      bytes = new Uint8Array(out.buffer);
    for (let plane = 4 - width; plane < 4; plane++) {
      const from = this.take(count);
      for (let k = 0; k < count; k++) bytes[4 * k + plane] = from[k];
    }
    return out;
  }
  // Integers of seven bits a byte, the sign in the lowest bit.
  integers(count) {
    const out = new Int32Array(count),
      bytes = this.bytes;
    let at = this.at;
    for (let k = 0; k < count; k++) {
      let byte = bytes[at++],
        value = byte & 127,
        weight = 128;
      while (byte > 127) {
        byte = bytes[at++];
        value += (byte & 127) * weight;
        weight *= 128;
      }
      out[k] = value % 2 ? -(value + 1) / 2 : value / 2;
    }
    this.at = at;
    return out;
  }
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Bytes of base64 text, in pieces so that no string grows beyond what browsers allow.
function fromBase64(text) {
  const PIECE = 1 << 20;
  const padding = text.endsWith("==") ? 2 : text.endsWith("=") ? 1 : 0;
  const out = new Uint8Array((text.length / 4) * 3 - padding);
  let at = 0;
  for (let from = 0; from < text.length; from += PIECE) {
    const piece = atob(text.slice(from, from + PIECE));
    for (let k = 0; k < piece.length; k++) out[at++] = piece.charCodeAt(k);
  }
  return out;
}

const STRAIGHT = 0.05; // Turn (rad) below which a corner lies on a straight side.

// Whether each corner is one of the reference shape, and not only a point on a side that may bend.
function realCorners({ blocks, corners, x, y }) {
  const real = new Uint8Array(corners);
  for (const block of blocks) {
    for (const [first, end] of block.loops) {
      for (let c = first; c < end; c++) {
        const before = c === first ? end - 1 : c - 1,
          after = c + 1 === end ? first : c + 1;
        const turn = Math.atan2(y[after] - y[c], x[after] - x[c]) - Math.atan2(y[c] - y[before], x[c] - x[before]);
        real[c] = Math.abs(turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI))) > STRAIGHT ? 1 : 0;
      }
      // A round block has no corner: all its points count.
      const loop = real.subarray(first, end);
      if (loop.reduce((sum, one) => sum + one, 0) < 3) loop.fill(1);
    }
  }
  return real;
}

// Places of all blocks and corners (m), relative to the origin, in arrays of one entry per block or corner.
function readOutlines(reader) {
  const count = reader.u32(),
    corners = reader.u32();
  const shape = { count, corners, originX: reader.f64(), originY: reader.f64(), size: reader.f64() };
  shape.blocks = [];
  let corner = 0;
  for (let k = 0; k < count; k++) {
    const block = { id: reader.u32(), fixed: reader.u8() === 1, first: corner, loops: [] };
    reader.u8();
    block.rock = reader.u16();
    block.area = reader.f64();
    block.mass = reader.f64();
    const loops = reader.u32();
    for (let loop = 0; loop < loops; loop++) {
      const end = corner + reader.u32();
      block.loops.push([corner, end]);
      corner = end;
    }
    block.end = corner;
    shape.blocks.push(block);
  }
  // Half of all blocks are larger than a square of this side (m).
  shape.side = Math.sqrt(shape.blocks.map((block) => block.area).sort((a, b) => a - b)[count >> 1] ?? 0);
  shape.centreX = reader.planes(count, 4);
  shape.centreY = reader.planes(count, 4);
  shape.x = reader.planes(corners, 4);
  shape.y = reader.planes(corners, 4);
  shape.real = realCorners(shape);
  shape.places = new Map(shape.blocks.map((block, k) => [block.id, k]));
  shape.points = corners;
  return shape;
}

// Whether a block holds a place in the reference configuration (m, from the origin).
function blockHolds({ x, y }, block, atX, atY) {
  let inside = false;
  for (const [first, end] of block.loops) {
    for (let c = first, before = end - 1; c < end; before = c++) {
      const spans = y[c] > atY !== y[before] > atY;
      if (spans && atX < x[c] + ((atY - y[c]) / (y[before] - y[c])) * (x[before] - x[c])) inside = !inside;
    }
  }
  return inside;
}

// Places in the blocks of one shape of the blocks of another: those of the same number, and of a part that is not there
// yet the block that it is a part of.
function placesIn(shape, other) {
  shape.placesIn ??= new Map();
  if (!shape.placesIn.has(other)) {
    const placed = shape.blocks.map(({ id }, k) => {
      const same = other.places.get(id);
      if (same !== undefined) return same;
      const [x, y] = [shape.centreX[k], shape.centreY[k]];
      return Math.max(0, other.blocks.findIndex((block) => blockHolds(other, block, x, y)));
    });
    shape.placesIn.set(other, placed);
  }
  return shape.placesIn.get(other);
}

// A frame of other blocks as one of the blocks of a shape: a part moves with the block that it is a part of.
function frameOf(frame, shape, numbers) {
  const parents = placesIn(shape, frame.shape);
  const taken = (values) => values.constructor.from(parents, (parent) => values[parent]);
  const seen = { ...frame, shape, removed: taken(frame.removed), edges: null, wet: null, quantum: 1 };
  for (const { name } of numbers) seen[name] = taken(frame[name]);
  parents.forEach((parent, k) => {
    const armX = shape.centreX[k] - frame.shape.centreX[parent],
      armY = shape.centreY[k] - frame.shape.centreY[parent],
      sine = Math.sin(frame.rotation[parent]),
      less = Math.cos(frame.rotation[parent]) - 1;
    seen.displacement_x[k] += armX * less - armY * sine;
    seen.displacement_y[k] += armX * sine + armY * less;
  });
  seen.restX = seen.restY = new Int8Array(shape.corners);
  seen.elements = null;
  return seen;
}

// `before` is the frame before, whose supports still hold unless others follow.
function readFrame(reader, time, shape, { monitors, bolts, block_numbers }, before) {
  const frame = { time, stage: reader.u32(), shape };
  const withEdges = reader.u8() === 1;
  const withSupports = reader.u8() === 1;
  reader.take(2);
  frame.quantum = reader.f64();
  frame.removed = reader.take(shape.count);
  const edges = withEdges ? reader.take(shape.corners) : null;
  frame.edges = edges?.map((state) => state & ~WET) ?? null;
  frame.wet = edges?.some((state) => state & WET) ? edges.map((state) => state & WET) : null;
  block_numbers.forEach(({ name }, k) => (frame[name] = reader.planes(shape.count, k < 2 ? 4 : 3)));
  frame.monitors = [];
  for (let k = 0; k < monitors.length; k++) {
    frame.monitors.push({ ux: reader.f32(), uy: reader.f32(), vx: reader.f32(), vy: reader.f32() });
  }
  frame.restX = slim(reader.integers(shape.corners));
  frame.restY = slim(reader.integers(shape.corners));
  readStructures(reader, frame, bolts.length, withSupports ? null : before.supports);
  // Until others follow, those of the frame before.
  frame.elements = before?.shape === shape ? before.elements : null;
  return frame;
}

function readSupports(reader) {
  const count = reader.u32();
  return { sign: reader.take(count), x: reader.planes(count, 3), y: reader.planes(count, 3) };
}

// Bolts, supports and water.
function readStructures(reader, frame, bolts, same) {
  frame.bolts = { state: reader.take(bolts) };
  for (const [name, width] of BOLT_NUMBERS) frame.bolts[name] = reader.planes(bolts, width);
  frame.supports = same ?? readSupports(reader);
  frame.water = { weight: reader.f64() };
  const points = reader.u32();
  [frame.water.x, frame.water.y] = [reader.planes(points, 4), reader.planes(points, 4)];
}

// The same integers in as few bytes as they need: frames stay in memory.
function slim(integers) {
  let most = 0;
  for (const value of integers) most = Math.max(most, Math.abs(value));
  return most < 128 ? Int8Array.from(integers) : most < 32768 ? Int16Array.from(integers) : integers;
}

// A film that is read from the bytes so far.
class Film {
  constructor() {
    this.head = null;
    // Blocks of the moment that is shown: others where some have broken meanwhile.
    this.shape = null;
    this.lastShape = null;
    this.frames = [];
    this.rows = { time: [], columns: [] };
    this.notes = [];
    this.begun = false;
    this.pending = new Uint8Array(0);
  }

  get start() {
    return Math.min(this.frames[0]?.time ?? Infinity, this.rows.time[0] ?? Infinity);
  }
  get end() {
    return Math.max(this.frames.at(-1)?.time ?? -Infinity, this.rows.time.at(-1) ?? -Infinity);
  }

  // Takes bytes behind those so far; a chunk that is not whole yet waits for its rest.
  async push(bytes) {
    let all = bytes;
    if (this.pending.length) {
      all = new Uint8Array(this.pending.length + bytes.length);
      all.set(this.pending);
      all.set(bytes, this.pending.length);
    }
    let at = 0;
    if (!this.begun && all.length >= MAGIC.length) {
      if (String.fromCharCode(...all.subarray(0, MAGIC.length)) !== MAGIC) throw new Error("this is no film of enmm");
      this.begun = true;
      at = MAGIC.length;
    }
    const chunks = [];
    while (this.begun && at + CHUNK_HEADER <= all.length) {
      const reader = new Reader(all.subarray(at));
      const kind = String.fromCharCode(...reader.take(4)),
        length = reader.u32(),
        time = reader.f64();
      if (at + CHUNK_HEADER + length > all.length) break;
      chunks.push({ kind, time, body: all.subarray(at + CHUNK_HEADER, at + CHUNK_HEADER + length) });
      at += CHUNK_HEADER + length;
    }
    this.pending = all.slice(at);
    // A few at a time: one by one is slow, all at once takes twice the memory.
    const BATCH = 16;
    for (let from = 0; from < chunks.length; from += BATCH) {
      const batch = chunks.slice(from, from + BATCH);
      const bodies = await Promise.all(batch.map((chunk) => inflate(chunk.body)));
      batch.forEach((chunk, k) => this.take(chunk, bodies[k]));
    }
    return chunks.length;
  }

  take({ kind, time }, body) {
    const reader = new Reader(body);
    const json = () => JSON.parse(new TextDecoder().decode(body));
    if (kind === "HEAD") {
      this.head = json();
      this.rows.columns = this.head.columns.map(() => []);
    } else if (kind === "OUTL") this.lastShape = this.shape = readOutlines(reader);
    else if (kind === "MESH") readMesh(reader, this.lastShape);
    else if (kind === "ELEM") this.takeElements(reader, time);
    else if (kind === "FRAM") this.frames.push(readFrame(reader, time, this.lastShape, this.head, this.frames.at(-1)));
    else if (kind === "ROWS") this.takeRows(reader);
    else if (kind === "NOTE") this.notes.push({ time, ...json() });
  }

  takeElements(reader, time) {
    const frame = this.frames.at(-1);
    frame.elements = readElements(reader, frame.shape, time, frame.elements);
  }

  takeRows(reader) {
    const count = reader.u32(),
      columns = reader.u32();
    for (let k = 0; k < count; k++) this.rows.time.push(reader.f64());
    for (let column = 1; column < columns; column++) {
      const numbers = reader.planes(count, 4),
        all = this.rows.columns[column];
      for (const number of numbers) all.push(number);
    }
  }

  // All notes of a kind; of each stage only what was noted last.
  of(kind) {
    const found = this.notes.filter((note) => note.note === kind);
    // A resumed run warns again of what was known before.
    const key = { stage: "number", warning: "text", changes: "title", break: "part" }[kind];
    return key ? [...new Map(found.map((note) => [note[key], note])).values()] : found;
  }

  // The last frame that is not later than a time.
  frameAt(time) {
    let low = 0,
      high = this.frames.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.frames[middle].time <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  // A frame as one of the blocks of a shape, by default of those that are shown.
  under(frame, shape = this.shape) {
    if (!frame || frame.shape === shape) return frame;
    if (frame.seen?.shape !== shape) frame.seen = frameOf(frame, shape, this.head.block_numbers);
    return frame.seen;
  }

  // Whether frames have a vector or tensor of blocks.
  has(whole) {
    return PARTS[whole].every((part) => this.head.block_numbers.some(({ name }) => name === part));
  }

  // Whether frames have openings and slips of joints.
  hasJoints() {
    return this.frames.some(({ shape, elements }) => elements && shape.joints.length);
  }

  // Numbers of blocks that are no part of a vector or tensor.
  others() {
    return this.head.block_numbers.filter(({ name }) => !OWN_ROWS.has(name));
  }

  // Displacement of each corner (m), at a fraction of the way from one frame to another, and of the other points of
  // elements where there are any: what the rigid motion of their block does, and what that leaves.
  displace(from, to, part, outX, outY) {
    const a = this.under(this.frames[from]);
    // Nothing moves on to a moment at which other blocks are there.
    const b = this.frames[to].shape === this.frames[from].shape ? this.under(this.frames[to]) : a;
    displaceBetween(a, b, part, outX, outY);
  }
}

// Displacement of all points (m) of a shape between two frames of it.
function displaceBetween(a, b, part, outX, outY) {
  const { blocks, centreX, centreY, x, y, corners } = a.shape,
    rest = 1 - part;
  const left = [a.restX, a.restY, b.restX, b.restY],
    motions = [a, b].map(({ elements }) => elements?.motion),
    leftBetween = motions.flatMap((motion) => motion?.values ?? [null, null]);
  const weights = [a.quantum * rest, b.quantum * part],
    weightsBetween = [(motions[0]?.quantum ?? 0) * rest, (motions[1]?.quantum ?? 0) * part];
  for (let k = 0; k < blocks.length; k++) {
    const ux = a.displacement_x[k] * rest + b.displacement_x[k] * part,
      uy = a.displacement_y[k] * rest + b.displacement_y[k] * part;
    // The shorter way round: rotations are known within half a turn.
    let way = b.rotation[k] - a.rotation[k];
    way -= 2 * Math.PI * Math.round(way / (2 * Math.PI));
    const turn = a.rotation[k] + part * way,
      sine = Math.sin(turn),
      less = Math.cos(turn) - 1;
    const move = (first, end, behind, [ax, ay, bx, by], [ofA, ofB]) => {
      for (let c = first; c < end; c++) {
        const armX = x[c] - centreX[k],
          armY = y[c] - centreY[k],
          at = c - behind;
        outX[c] = ux + armX * less - armY * sine + (ax ? ax[at] * ofA : 0) + (bx ? bx[at] * ofB : 0);
        outY[c] = uy + armX * sine + armY * less + (ay ? ay[at] * ofA : 0) + (by ? by[at] * ofB : 0);
      }
    };
    move(blocks[k].first, blocks[k].end, 0, left, weights);
    if (blocks[k].points) move(...blocks[k].points, corners, leftBetween, weightsBetween);
  }
}
