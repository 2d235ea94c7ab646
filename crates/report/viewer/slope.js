// The slope on its canvas: camera, drawing, and what lies under a pointer. Places are in metres from the film's origin.

const TINY = 24; // Pixels below which a block is drawn by its corners alone.
const AT_A_TIME = 16; // Blocks of one colour that are filled together.
const REACH = 12; // How near (CSS pixels) a click must come to a monitor.
const FOOT = 30; // Height of the length bar with its label (px).

class Slope {
  constructor(canvas, film) {
    this.canvas = canvas;
    this.film = film;
    this.pen = canvas.getContext("2d");
    this.camera = { x: 0, y: 0, scale: 1 };
    this.makeRoom();
    this.fitted = true;
  }

  // Arrays for the corners of the blocks that are shown, and the other points of elements.
  makeRoom() {
    const { points } = this.film.shape;
    for (const name of ["x", "y", "baseX", "baseY"]) this[name] = new Float32Array(points);
  }

  // Puts every point where it is drawn. `base` is a frame from which displacements count, or null.
  pose(moment, magnification, base) {
    const { film } = this,
      shape = film.shape;
    if (this.x.length !== shape.points) this.makeRoom();
    const { x, y } = this;
    this.magnification = magnification;
    film.displace(moment.from, moment.to, moment.part, x, y);
    if (base !== null) film.displace(base, base, 0, this.baseX, this.baseY);
    for (let c = 0; c < shape.points; c++) {
      const fromX = base === null ? 0 : this.baseX[c],
        fromY = base === null ? 0 : this.baseY[c];
      x[c] = shape.x[c] + fromX + magnification * (x[c] - fromX);
      y[c] = shape.y[c] + fromY + magnification * (y[c] - fromY);
    }
  }

  // Makes the canvas as fine as the screen.
  resize() {
    const { clientWidth, clientHeight } = this.canvas,
      ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
    if (this.canvas.width === width && this.canvas.height === height) return;
    [this.canvas.width, this.canvas.height] = [width, height];
    if (this.fitted) this.fit();
  }

  // Shows all rock of the reference configuration, with air for what falls and a foot for the length bar.
  fit() {
    const { x, y } = this.film.shape,
      { clientWidth: width, clientHeight: height } = this.canvas;
    let [left, right, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
    for (let c = 0; c < x.length; c++) {
      [left, right] = [Math.min(left, x[c]), Math.max(right, x[c])];
      [low, high] = [Math.min(low, y[c]), Math.max(high, y[c])];
    }
    const scale = Math.min(width / ((right - left) * 1.08 || 1), (height - 2 * FOOT) / ((high - low) * 1.06 || 1)) || 1;
    this.camera = { x: 0.5 * (left + right), y: 0.5 * (low + high) - (0.5 * FOOT) / scale, scale };
    this.fitted = true;
  }

  toScreen(x, y) {
    const { camera, canvas } = this;
    return [
      (x - camera.x) * camera.scale + canvas.clientWidth / 2,
      (camera.y - y) * camera.scale + canvas.clientHeight / 2,
    ];
  }

  toWorld(px, py) {
    const { camera, canvas } = this;
    return [
      camera.x + (px - canvas.clientWidth / 2) / camera.scale,
      camera.y - (py - canvas.clientHeight / 2) / camera.scale,
    ];
  }

  // Zooms by a factor and keeps the place under a pixel where it is.
  zoom(factor, px = this.canvas.clientWidth / 2, py = this.canvas.clientHeight / 2) {
    const [x, y] = this.toWorld(px, py),
      camera = this.camera;
    camera.scale = Math.min(Math.max(camera.scale * factor, 1e-6), 1e9);
    const [nowX, nowY] = this.toWorld(px, py);
    camera.x += x - nowX;
    camera.y += y - nowY;
    this.fitted = false;
  }

  pan(dx, dy) {
    this.camera.x -= dx / this.camera.scale;
    this.camera.y += dy / this.camera.scale;
    this.fitted = false;
  }

  // Notes what is in sight, and how places become pixels: asking the canvas for every block would take time.
  look() {
    const { camera, canvas } = this,
      { scale } = camera;
    const [west, north] = this.toWorld(0, 0),
      [east, south] = this.toWorld(canvas.clientWidth, canvas.clientHeight);
    const shiftX = canvas.clientWidth / 2 - camera.x * scale,
      shiftY = canvas.clientHeight / 2 + camera.y * scale;
    this.view = { scale, shiftX, shiftY, west, north, east, south };
  }

  // Least and greatest x, then least and greatest y of a block (m).
  bounds(block) {
    const { x, y } = this;
    let [left, right, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
    for (let c = block.first; c < block.end; c++) {
      if (x[c] < left) left = x[c];
      if (x[c] > right) right = x[c];
      if (y[c] < low) low = y[c];
      if (y[c] > high) high = y[c];
    }
    return [left, right, low, high];
  }

  // Begins a path with the loops of a block, and returns whether any of it is in sight.
  //
  // Every block is a path of its own, unless it is joined to the one before: browsers fill ten thousand small paths in
  // some 30 ms, and one path with as many loops in a second.
  trace(block, joined = false) {
    const { x, y, pen } = this,
      { scale, shiftX, shiftY, west, east, south, north } = this.view,
      [left, right, low, high] = this.bounds(block);
    if (right < west || left > east || high < south || low > north) return false;
    // The bending of a side is not visible on a block of a few pixels.
    const wanted = Math.max(right - left, high - low) * scale < TINY ? this.film.shape.real : null;
    if (!joined) pen.beginPath();
    for (const [first, end] of block.loops) {
      let begun = false;
      for (let c = first; c < end; c++) {
        if (wanted && !wanted[c]) continue;
        if (begun) pen.lineTo(x[c] * scale + shiftX, shiftY - y[c] * scale);
        else pen.moveTo(x[c] * scale + shiftX, shiftY - y[c] * scale);
        begun = true;
      }
      pen.closePath();
    }
    return true;
  }

  // Draws blocks in the colours that `paint(k)` gives, then what `over` lists.
  draw(frame, paint, over, theme) {
    const { pen, canvas, film } = this,
      ratio = window.devicePixelRatio || 1;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    this.look();
    // The usual side of a block on the screen (pixels): outlines of tiny blocks would only darken the picture.
    const side = film.shape.side * this.camera.scale;
    const ofLines = over.joints || over.moved;
    if (over.elements) drawElements(this, frame, over.elements);
    if (ofLines) this.fillAlike(frame, theme.line);
    pen.strokeStyle = theme.edge;
    pen.lineWidth = side > 14 ? 1 : 0.5;
    pen.lineJoin = "bevel";
    film.shape.blocks.forEach((block, k) => {
      if (frame.removed[k] || ofLines || (over.elements && side <= 4) || !this.trace(block)) return;
      if (!over.elements) {
        pen.fillStyle = paint(k);
        pen.fill();
      }
      if (side > 4) pen.stroke();
    });
    if (over.joints && frame.edges) this.drawJoints(frame, theme, side);
    if (over.moved) drawMovedJoints(this, frame, over.moved);
    if (over.crosses) drawCrosses(this, frame, over.crosses, theme);
    for (const mark of over.marks) this.drawMark(mark, frame, theme);
    if (over.bolts) drawStructures(this, frame, over.bolts, theme);
    if (over.block !== null && !frame.removed[over.block]) this.drawBlock(film.shape.blocks[over.block], theme);
    if (film.shape.starts) drawProbe(this, frame, over, theme);
    if (over.cursor) this.drawCursor(over.cursor, theme);
    over.monitors.forEach((monitor, k) => this.drawMonitor(monitor, k === over.monitor, theme));
  }

  // Fills all blocks in one colour, some at a time.
  fillAlike(frame, colour) {
    const { pen } = this;
    pen.fillStyle = colour;
    pen.beginPath();
    let count = 0;
    this.film.shape.blocks.forEach((block, k) => {
      if (frame.removed[k] || !this.trace(block, true) || ++count % AT_A_TIME) return;
      pen.fill();
      pen.beginPath();
    });
    pen.fill();
  }

  // Edges by state; slipping ones and bridges on top. Dashes need blocks of some size to be seen.
  drawJoints(frame, theme, side) {
    for (const state of [OPEN, LOCK, SLIP, BRIDGE, BROKEN_BRIDGE]) {
      const style = jointStyle(state, theme),
        { pen } = this;
      pen.strokeStyle = style.colour;
      pen.lineWidth = side > 14 ? style.width : 0.5 * style.width;
      pen.setLineDash(side > 14 ? style.dash : []);
      this.film.shape.blocks.forEach((block, k) => {
        if (!frame.removed[k]) this.strokeEdges(block, frame.edges, state);
      });
    }
    this.pen.setLineDash([]);
  }

  // Strokes the edges of a block that are in a state, neighbours as one line.
  strokeEdges(block, edges, state) {
    const { pen, x, y } = this,
      { scale, shiftX, shiftY } = this.view;
    let begun = false;
    for (const [first, end] of block.loops) {
      let drawing = false;
      for (let c = first; c < end; c++) {
        const wanted = edges[c] === state,
          next = c + 1 < end ? c + 1 : first;
        if (wanted && !begun) pen.beginPath();
        if (wanted && !drawing) pen.moveTo(x[c] * scale + shiftX, shiftY - y[c] * scale);
        if (wanted) pen.lineTo(x[next] * scale + shiftX, shiftY - y[next] * scale);
        begun ||= wanted;
        drawing = wanted;
      }
    }
    if (begun) pen.stroke();
  }

  // Hatches blocks and draws their outlines thick.
  drawMark(mark, frame, theme) {
    const { pen } = this;
    pen.fillStyle = this.hatch(theme);
    pen.strokeStyle = theme.mark;
    pen.lineWidth = 2.5;
    for (const k of mark) {
      if (frame.removed[k] || !this.trace(this.film.shape.blocks[k])) continue;
      pen.fill();
      pen.stroke();
    }
  }

  // Slanted lines in the colour of marks.
  hatch(theme) {
    const tile = document.createElement("canvas");
    tile.width = tile.height = 12;
    const pen = tile.getContext("2d");
    pen.strokeStyle = theme.mark;
    pen.lineWidth = 1.4;
    pen.beginPath();
    for (const shift of [-12, 0, 12]) {
      pen.moveTo(shift, 12);
      pen.lineTo(shift + 12, 0);
    }
    pen.stroke();
    return this.pen.createPattern(tile, "repeat");
  }

  drawBlock(block, theme) {
    if (!this.trace(block)) return;
    this.pen.strokeStyle = theme.halo;
    this.pen.lineWidth = 6;
    this.pen.stroke();
    this.pen.strokeStyle = theme.accent;
    this.pen.lineWidth = 3;
    this.pen.stroke();
  }

  // The place that arrow keys with Shift move.
  drawCursor([px, py], theme) {
    const { pen } = this;
    for (const [colour, width] of [
      [theme.halo, 5],
      [theme.ink, 1.8],
    ]) {
      pen.beginPath();
      for (const [dx, dy] of [
        [1, 0],
        [-1, 0],
        [0, 1],
        [0, -1],
      ]) {
        pen.moveTo(px + 4 * dx, py + 4 * dy);
        pen.lineTo(px + 13 * dx, py + 13 * dy);
      }
      pen.strokeStyle = colour;
      pen.lineWidth = width;
      pen.stroke();
    }
  }

  drawMonitor(monitor, chosen, theme) {
    const { pen } = this,
      [x, y] = this.toScreen(monitor.x, monitor.y);
    pen.beginPath();
    pen.arc(x, y, chosen ? 7 : 5, 0, 2 * Math.PI);
    pen.fillStyle = chosen ? theme.accent : theme.paper;
    pen.fill();
    pen.strokeStyle = theme.ink;
    pen.lineWidth = 1.8;
    pen.stroke();
    pen.font = "600 12px system-ui, sans-serif";
    pen.lineWidth = 3.5;
    pen.strokeStyle = theme.halo;
    pen.strokeText(monitor.name, x + 9, y - 7);
    pen.fillStyle = theme.ink;
    pen.fillText(monitor.name, x + 9, y - 7);
  }

  // The monitor that lies under a pixel, or a block with an element, and a joint near by.
  pick(px, py, frame, monitors) {
    const near = monitors.findIndex((monitor) => {
      const [x, y] = this.toScreen(monitor.x, monitor.y);
      return Math.hypot(px - x, py - y) <= REACH;
    });
    if (near >= 0) return { monitor: near };
    const [x, y] = this.toWorld(px, py),
      { blocks, count } = this.film.shape,
      joint = jointAt(this, frame, x, y);
    // The last that is drawn lies on top.
    for (let k = count - 1; k >= 0; k--) {
      if (!frame.removed[k] && this.holds(blocks[k], x, y))
        return { block: k, element: elementAt(this, blocks[k], x, y), joint };
    }
    return { joint };
  }

  // Whether a block holds a place: crossings of a ray with its loops, holes included.
  holds(block, px, py) {
    const { x, y } = this;
    let inside = false;
    for (const [first, end] of block.loops) {
      for (let c = first, before = end - 1; c < end; before = c++) {
        if (y[c] > py === y[before] > py) continue;
        if (px < x[c] + ((py - y[c]) / (y[before] - y[c])) * (x[before] - x[c])) inside = !inside;
      }
    }
    return inside;
  }
}
