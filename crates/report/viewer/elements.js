// Elements, the parts of blocks with a stress of their own, and joints: reading them, their numbers, and drawing.
//
// A film holds what the rigid motion and the mean stress of its block leave of the numbers of an element, in quanta,
// and mostly only what has changed since those before.

const JOINT_STEPS = 16; // Steps in which openings and slips double.
const JOINT_SMALL = 262144; // Size of the model over the opening or slip below which a step is a length.
const LINE_WIDTHS = [1.4, 6]; // Of joints by opening or slip, from the least to the greatest (px).
const CROSS = 13; // Half the length of the arm of a cross for the usual greatest stress (px).
const CROSS_TENSION = 6; // The same at least of tension, so that its bars stand apart (px).
const CROSS_APART = 30; // Pixels between two crosses.
const JOINT_REACH = 7; // How near (px) a click must come to a joint.

// The elements of the blocks of a shape. Their points are the corners of the blocks, and others behind those.
function readMesh(reader, shape) {
  const elements = reader.u32(),
    points = reader.u32(),
    unit = reader.f64();
  let [element, point] = [0, shape.corners];
  for (const block of shape.blocks) {
    block.elements = [element, (element += reader.u32())];
    block.points = [point, (point += reader.u32())];
  }
  for (const axis of ["x", "y"]) {
    const all = new Float32Array(shape.corners + points);
    all.set(shape[axis]);
    let at = 0;
    reader.integers(points).forEach((way, k) => (all[shape.corners + k] = (at += way) * unit));
    shape[axis] = all;
  }
  shape.points = shape.corners + points;
  shape.elements = elements;
  const sides = reader.integers(elements);
  shape.starts = new Uint32Array(elements + 1);
  sides.forEach((count, e) => (shape.starts[e + 1] = shape.starts[e] + count));
  shape.ring = Uint32Array.from(reader.integers(shape.starts[elements]));
  readRings(shape);
  // Corners whose edges face another, so that they have an opening and a slip.
  const faces = reader.take(shape.corners);
  shape.joints = Uint32Array.from([...faces.keys()].filter((corner) => faces[corner]));
  // The block of each, and the corner behind every corner.
  const blockOf = new Uint32Array(shape.corners);
  shape.after = new Uint32Array(shape.corners);
  shape.blocks.forEach(({ loops }, k) => {
    for (const [first, end] of loops)
      for (let c = first; c < end; c++) [blockOf[c], shape.after[c]] = [k, c + 1 < end ? c + 1 : first];
  });
  shape.ofJoint = Uint32Array.from(shape.joints, (corner) => blockOf[corner]);
}

// Makes places of the whole film of the steps between the points of each block.
function readRings(shape) {
  shape.middleX = new Float32Array(shape.elements);
  shape.middleY = new Float32Array(shape.elements);
  for (const block of shape.blocks) {
    const [first, end] = block.elements,
      corners = block.end - block.first;
    let at = 0;
    for (let e = first; e < end; e++) {
      let [x, y] = [0, 0];
      for (let k = shape.starts[e]; k < shape.starts[e + 1]; k++) {
        at += shape.ring[k] | 0;
        const place = (shape.ring[k] = at < corners ? block.first + at : block.points[0] + at - corners);
        x += shape.x[place];
        y += shape.y[place];
      }
      const sides = shape.starts[e + 1] - shape.starts[e];
      [shape.middleX[e], shape.middleY[e]] = [x / sides, y / sides];
    }
  }
}

// Numbers of several parts in quanta: what comes new, or what changes since `before`.
function readSeries(reader, count, parts, before) {
  const quantum = reader.f64(),
    ratio = before ? before.quantum / quantum : 0;
  const values = Array.from({ length: parts }, (_, part) => {
    const now = reader.integers(count);
    if (before) {
      const then = before.values[part];
      for (let k = 0; k < count; k++) if (then[k]) now[k] += Math.floor(then[k] * ratio + 0.5);
    }
    return slim(now);
  });
  return { quantum, values };
}

// Numbers of elements and joints at a time (s); changes count from those before.
function readElements(reader, shape, time, before) {
  const known = reader.u8() === 1 ? before : null;
  return {
    time,
    motion: readSeries(reader, shape.points - shape.corners, 2, known?.motion),
    velocity: readSeries(reader, shape.elements, 2, known?.velocity),
    stress: readSeries(reader, shape.elements, 3, known?.stress),
    joints: readSeries(reader, shape.joints.length, 2, known?.joints),
  };
}

// Displacement (m) of all points of a frame.
function displacementOf(frame) {
  const [x, y] = [new Float32Array(frame.shape.points), new Float32Array(frame.shape.points)];
  displaceBetween(frame, frame, 0, x, y);
  return [x, y];
}

// Calls with each element of the blocks that are there, and its block.
function eachElement(frame, work) {
  frame.shape.blocks.forEach(({ elements }, k) => {
    if (frame.removed[k]) return;
    for (let e = elements[0]; e < elements[1]; e++) work(e, k);
  });
}

// Displacement (m) of an element: the mean of its points.
function displacementOfElement({ starts, ring }, [x, y], e) {
  let [ux, uy] = [0, 0];
  for (let place = starts[e]; place < starts[e + 1]; place++) {
    ux += x[ring[place]];
    uy += y[ring[place]];
  }
  const sides = starts[e + 1] - starts[e];
  return [ux / sides, uy / sides];
}

// Velocity (m/s) of an element: of the rigid motion of its block, and what that leaves.
function velocityOfElement(frame, e, k) {
  const { shape, rotation, angular_velocity } = frame,
    [armX, armY] = [shape.middleX[e] - shape.centreX[k], shape.middleY[e] - shape.centreY[k]];
  const [cosine, sine] = [Math.cos(rotation[k]), Math.sin(rotation[k])],
    { quantum, values } = frame.elements.velocity;
  return [
    frame.velocity_x[k] - angular_velocity[k] * (armX * sine + armY * cosine) + values[0][e] * quantum,
    frame.velocity_y[k] + angular_velocity[k] * (armX * cosine - armY * sine) + values[1][e] * quantum,
  ];
}

// Stress xx, yy, xy (Pa) of an element.
function stressOfElement(frame, e, k) {
  const { quantum, values } = frame.elements.stress;
  return PARTS.stress.map((part, n) => frame[part][k] + values[n][e] * quantum);
}

// Numbers of all elements of a frame by which they are coloured; those of blocks that are not there are NaN.
const OF_ELEMENTS = {
  displacement(frame, out, base) {
    const now = displacementOf(frame),
      then = base ? displacementOf(base) : null;
    eachElement(frame, (e) => {
      const [x, y] = displacementOfElement(frame.shape, now, e),
        [fromX, fromY] = then ? displacementOfElement(frame.shape, then, e) : [0, 0];
      out[e] = Math.hypot(x - fromX, y - fromY);
    });
  },
  velocity(frame, out) {
    eachElement(frame, (e, k) => (out[e] = Math.hypot(...velocityOfElement(frame, e, k))));
  },
  stress(frame, out) {
    const [{ mean_stress_xx: xx, mean_stress_yy: yy }, { quantum, values }] = [frame, frame.elements.stress];
    eachElement(frame, (e, k) => (out[e] = 0.5 * (xx[k] + yy[k] + (values[0][e] + values[1][e]) * quantum)));
  },
  shear(frame, out) {
    const { mean_stress_xx: xx, mean_stress_yy: yy, mean_stress_xy: xy } = frame,
      { quantum, values } = frame.elements.stress;
    eachElement(frame, (e, k) => {
      const half = 0.5 * (xx[k] - yy[k] + (values[0][e] - values[1][e]) * quantum);
      out[e] = Math.hypot(half, xy[k] + values[2][e] * quantum);
    });
  },
};

// Numbers of the elements of a frame for a colour; null where the frame has none or the colour is of blocks.
function numbersOfElements(frame, key, base) {
  if (!frame.elements || !OF_ELEMENTS[key]) return null;
  const out = new Float32Array(frame.shape.elements).fill(NaN);
  OF_ELEMENTS[key](frame, out, base);
  return out;
}

// Opening and slip (m) of the joint j of a frame.
function movedOfJoint({ shape, elements }, j) {
  const small = shape.size / JOINT_SMALL;
  return elements.joints.values.map((all) => Math.sign(all[j]) * small * (2 ** (Math.abs(all[j]) / JOINT_STEPS) - 1));
}

// Opening or slip (m) of each joint; NaN where its block is not there.
function numbersOfJoints(frame, key) {
  const { shape, elements } = frame,
    part = key === "opening" ? 0 : 1;
  return Float32Array.from(shape.joints, (_, j) =>
    frame.removed[shape.ofJoint[j]] ? NaN : movedOfJoint(frame, j)[part],
  );
}

// Smallest and largest number over frames by which elements or joints are coloured, as `rangeOf` has them of blocks.
// At most so many numbers are sorted.
const SORTED = 100000;

function rangeOfParts(frames, of, logarithmic) {
  const all = frames.map(of).filter(Boolean),
    count = all.reduce((sum, numbers) => sum + numbers.length, 0),
    stride = Math.ceil(count / SORTED) || 1;
  const sample = [];
  let most = 0;
  for (const numbers of all) {
    for (let k = 0; k < numbers.length; k += stride) if (!Number.isNaN(numbers[k])) sample.push(numbers[k]);
    if (logarithmic) for (const number of numbers) if (number > most) most = number;
  }
  if (!sample.length) return [0, 1];
  const sorted = Float64Array.from(sample).sort(),
    cut = Math.floor(sorted.length / 200);
  const [low, high] = logarithmic ? [0, most] : [sorted[cut], sorted[sorted.length - 1 - cut]];
  return high > low ? [low, high] : [low, low + (Math.abs(low) || 1)];
}

// Fills polygons in flat colours, pixel by pixel: ten thousand small paths take a canvas twice the time between two
// pictures of the screen, and leave a rim of the paper between neighbours.
class Raster {
  // Where the sides of a polygon cross a line of pixels.
  crossings = new Float64Array(4096);

  begin(width, height) {
    if (this.image?.width !== width || this.image.height !== height) {
      this.image = new ImageData(width, height);
      this.pixels = new Uint32Array(this.image.data.buffer);
    } else this.pixels.fill(0);
  }

  // The polygon of the points `ring[from..to]` at the pixels x, y.
  fill(x, y, ring, from, to, colour) {
    const { width, height } = this.image,
      { pixels, crossings } = this;
    let [top, bottom] = [Infinity, -Infinity];
    for (let k = from; k < to; k++) {
      const at = y[ring[k]];
      if (at < top) top = at;
      if (at > bottom) bottom = at;
    }
    const end = Math.min(height, Math.ceil(bottom - 0.5));
    for (let row = Math.max(0, Math.ceil(top - 0.5)); row < end; row++) {
      const level = row + 0.5;
      let count = 0,
        before = ring[to - 1];
      for (let k = from; k < to; k++) {
        const point = ring[k];
        if (y[point] <= level !== y[before] <= level) {
          // Always from the same end, so that neighbours meet at the same pixel.
          const [a, b] = y[point] < y[before] ? [point, before] : [before, point];
          let at = x[a] + ((level - y[a]) * (x[b] - x[a])) / (y[b] - y[a]),
            place = count++;
          for (; place > 0 && crossings[place - 1] > at; place--) crossings[place] = crossings[place - 1];
          crossings[place] = at;
        }
        before = point;
      }
      for (let k = 0; k + 1 < count; k += 2) {
        const left = Math.max(0, Math.ceil(crossings[k] - 0.5)),
          right = Math.min(width, Math.ceil(crossings[k + 1] - 0.5));
        // Faster than `fill` on some ten pixels.
        for (let at = row * width + left; at < row * width + right; at++) pixels[at] = colour;
      }
    }
  }
}

// A colour of CSS, rgb(r g b), as a word of an image.
function wordOf(colour) {
  const [r, g, b] = colour.match(/\d+/g).map(Number);
  return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
}

const WORDS = Object.fromEntries(Object.entries(RAMPS).map(([name, colours]) => [name, colours.map(wordOf)]));

// Draws the elements of all blocks that are there, each in the colour of its step.
function drawElements(slope, frame, { steps, words }) {
  const { shape } = frame,
    { scale, shiftX, shiftY, west, east, south, north } = slope.view,
    ratio = window.devicePixelRatio || 1,
    raster = (slope.raster ??= new Raster());
  if (slope.pixelX?.length !== shape.points)
    [slope.pixelX, slope.pixelY] = [new Float32Array(shape.points), new Float32Array(shape.points)];
  const { pixelX, pixelY, x, y } = slope;
  for (let k = 0; k < shape.points; k++) {
    pixelX[k] = (x[k] * scale + shiftX) * ratio;
    pixelY[k] = (shiftY - y[k] * scale) * ratio;
  }
  raster.begin(slope.canvas.width, slope.canvas.height);
  shape.blocks.forEach((block, k) => {
    if (frame.removed[k]) return;
    const [left, right, low, high] = slope.bounds(block);
    if (right < west || left > east || high < south || low > north) return;
    for (let e = block.elements[0]; e < block.elements[1]; e++)
      raster.fill(pixelX, pixelY, shape.ring, shape.starts[e], shape.starts[e + 1], words[steps[e]]);
  });
  slope.pen.putImageData(raster.image, 0, 0);
}

// Draws joints in the colours and widths of the steps of their numbers; those without a number stay thin.
function drawMovedJoints(slope, { shape }, { steps, colours }) {
  const { pen, x, y } = slope,
    { scale, shiftX, shiftY } = slope.view,
    [thin, wide] = LINE_WIDTHS;
  const by = colours.map(() => []);
  steps.forEach((step, j) => step < STEPS && by[step].push(shape.joints[j]));
  by.forEach((corners, step) => {
    if (!corners.length) return;
    pen.strokeStyle = colours[step];
    pen.lineWidth = thin + ((wide - thin) * step) / (STEPS - 1);
    pen.beginPath();
    let last = null;
    for (const c of corners) {
      const next = shape.after[c];
      // Neighbours are one line.
      if (c !== last) pen.moveTo(x[c] * scale + shiftX, shiftY - y[c] * scale);
      pen.lineTo(x[next] * scale + shiftX, shiftY - y[next] * scale);
      last = next;
    }
    pen.stroke();
  });
}

// Draws the principal stresses of elements as crosses: compression thin, tension thick with bars at its ends.
function drawCrosses(slope, frame, most, theme) {
  const { pen, canvas } = slope,
    taken = new Set(),
    arms = [[], []];
  eachElement(frame, (e, k) => {
    const [px, py] = middleOfElement(slope, e);
    if (px < 0 || py < 0 || px > canvas.clientWidth || py > canvas.clientHeight) return;
    const cell = Math.floor(px / CROSS_APART) * 10000 + Math.floor(py / CROSS_APART);
    if (taken.has(cell)) return;
    taken.add(cell);
    const [major, minor, angle] = principal(...stressOfElement(frame, e, k));
    [[major, angle], [minor, angle + 0.5 * Math.PI]].forEach(([stress, along]) => {
      const share = CROSS * Math.min(1.5, Math.abs(stress) / most),
        long = stress > 0 ? Math.max(share, CROSS_TENSION) : share;
      if (share > 0.7) arms[stress > 0 ? 1 : 0].push([px, py, long * Math.cos(along), -long * Math.sin(along)]);
    });
  });
  arms.forEach((all, isTension) => {
    const path = new Path2D();
    for (const [px, py, dx, dy] of all) {
      path.moveTo(px - dx, py - dy);
      path.lineTo(px + dx, py + dy);
      if (!isTension) continue;
      const share = 3.5 / Math.hypot(dx, dy);
      for (const end of [-1, 1]) {
        path.moveTo(px + end * dx - dy * share, py + end * dy + dx * share);
        path.lineTo(px + end * dx + dy * share, py + end * dy - dx * share);
      }
    }
    pen.strokeStyle = theme.halo;
    pen.lineWidth = isTension ? 5 : 3;
    pen.stroke(path);
    pen.strokeStyle = isTension ? theme.mark : theme.ink;
    pen.lineWidth = isTension ? 2.6 : 1.1;
    pen.stroke(path);
  });
}

// The pixel of the middle of an element as it is drawn.
function middleOfElement(slope, e) {
  return slope.toScreen(...displacementOfElement(slope.film.shape, [slope.x, slope.y], e));
}

// The element of a block that holds a place (m), or null.
function elementAt(slope, block, atX, atY) {
  const { starts, ring } = slope.film.shape,
    { x, y } = slope;
  for (let e = block.elements?.[0]; e < block.elements?.[1]; e++) {
    let inside = false,
      before = ring[starts[e + 1] - 1];
    for (let k = starts[e]; k < starts[e + 1]; before = ring[k++]) {
      const point = ring[k];
      if (y[point] > atY === y[before] > atY) continue;
      if (atX < x[point] + ((atY - y[point]) / (y[before] - y[point])) * (x[before] - x[point])) inside = !inside;
    }
    if (inside) return e;
  }
  return null;
}

// The joint nearest to a place (m) within reach, or null.
function jointAt(slope, frame, atX, atY) {
  const { shape } = frame,
    { x, y } = slope;
  let [nearest, least] = [null, JOINT_REACH / slope.camera.scale];
  shape.joints?.forEach((c, j) => {
    if (frame.removed[shape.ofJoint[j]]) return;
    const next = shape.after[c],
      [alongX, alongY] = [x[next] - x[c], y[next] - y[c]];
    const share = ((atX - x[c]) * alongX + (atY - y[c]) * alongY) / (alongX * alongX + alongY * alongY || 1),
      on = Math.max(0, Math.min(1, share));
    const far = Math.hypot(atX - x[c] - on * alongX, atY - y[c] - on * alongY);
    if (far < least) [nearest, least] = [j, far];
  });
  return nearest;
}

// Draws what a probe has found: the rim of the element, and the joint as a thick line.
function drawProbe(slope, { shape }, { element, joint }, theme) {
  const { pen, x, y } = slope,
    { scale, shiftX, shiftY } = slope.view;
  const path = (points) => {
    pen.beginPath();
    for (const point of points) pen.lineTo(x[point] * scale + shiftX, shiftY - y[point] * scale);
  };
  const stroke = (width) => {
    pen.strokeStyle = theme.halo;
    pen.lineWidth = width + 3;
    pen.stroke();
    pen.strokeStyle = theme.accent;
    pen.lineWidth = width;
    pen.stroke();
  };
  if (element !== null) {
    path(shape.ring.subarray(shape.starts[element], shape.starts[element + 1]));
    pen.closePath();
    stroke(2);
  }
  if (joint !== null) {
    path([shape.joints[joint], shape.after[shape.joints[joint]]]);
    stroke(5);
  }
}

// Numbers of an element of block k in a frame.
function numbersOfElement(frame, e, k) {
  const [ux, uy] = displacementOfElement(frame.shape, displacementOf(frame), e),
    [vx, vy] = velocityOfElement(frame, e, k),
    stress = stressOfElement(frame, e, k),
    [major, minor, angle] = principal(...stress);
  return [
    measured("Displacement", Math.hypot(ux, uy), "m"),
    measured("Speed", Math.hypot(vx, vy), "m/s"),
    measured("Mean stress", 0.5 * (major + minor), "Pa"),
    measured("Greatest shear stress", 0.5 * (major - minor), "Pa"),
    measured("σ1 (greatest)", major, "Pa"),
    measured("σ2 (least)", minor, "Pa"),
    measured("σ1 from x axis", angle, "rad"),
    ...["σxx", "σyy", "σxy"].map((name, part) => measured(name, stress[part], "Pa")),
    measured("Stress is within ±", frame.elements.stress.quantum, "Pa"),
  ];
}

const JOINT_STATES = ["free", "open", "slips", "locked", "bridge that holds", "broken bridge"];

function numbersOfJoint(frame, j) {
  const [opening, slip] = movedOfJoint(frame, j),
    state = frame.edges?.[frame.shape.joints[j]];
  return [
    ...(state === undefined ? [] : [["State", JOINT_STATES[state]]]),
    measured("Opening", opening, "m"),
    measured("Slip", slip, "m"),
  ];
}

// Numbers that a probe reads beside those of its block, in a frame.
function probeSection({ block, element: e, joint }, frame) {
  const made = element("section", { id: "probe" });
  if (!frame.elements) return made;
  if (e !== null) made.append(element("h2", {}, "Element"), table(numbersOfElement(frame, e, block)));
  if (joint !== null) made.append(element("h2", {}, "Joint"), table(numbersOfJoint(frame, joint)));
  const since = frame.elements.time;
  if ((e !== null || joint !== null) && since < frame.time)
    made.append(
      element("p", { class: "soft" }, `Joints, and how elements differ from their block, at ${digits(since)} s.`),
    );
  return made;
}

// Charts of an element and of a joint over the frames with the blocks of now that have numbers of them.
function chartsOfProbe(film, { block, element, joint }) {
  const frames = film.frames.filter(
    ({ shape, elements, time }) => shape === film.shape && elements && elements.time === time,
  );
  const time = frames.map((frame) => frame.time);
  const chart = (what, unit, names, of) => {
    const values = frames.map(of);
    const series = names.map((name, k) => ({ name, time, values: values.map((parts) => parts[k]) }));
    return { name: `${what} (${unit})`, unit, series };
  };
  const charts = [];
  if (frames.length && element !== null) {
    const speed = (frame) => [Math.hypot(...velocityOfElement(frame, element, block))];
    const stress = (frame) => {
      const [major, minor] = principal(...stressOfElement(frame, element, block));
      return [major, minor, 0.5 * (major + minor)];
    };
    charts.push(chart("Element: stress", "Pa", ["σ1", "σ2", "mean"], stress));
    charts.push(chart("Element: speed", "m/s", ["speed"], speed));
  }
  if (frames.length && joint !== null)
    charts.push(chart("Joint: opening and slip", "m", ["opening", "slip"], (frame) => movedOfJoint(frame, joint)));
  return charts;
}
