// The clock of the film: playing, stepping, and the speed.

class Player {
  constructor(film, changed) {
    this.film = film;
    this.changed = changed;
    this.time = film.end;
    this.playing = false;
    this.speed = this.speeds()[0];
    this.last = 0;
  }

  // Speeds of the series 1, 2, 5 on both sides of one that shows the film in some eight seconds, which comes first.
  speeds() {
    const usual = roundUp((this.film.end - this.film.start) / 8 || 1);
    return [usual, ...[0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 2, 5, 10].map((factor) => roundUp(usual * factor))];
  }

  seek(time) {
    this.time = Math.max(this.film.start, Math.min(this.film.end, time));
    this.changed();
  }

  // Goes to the next frame, or back to the last one.
  step(count) {
    this.pause();
    const { frames } = this.film,
      at = this.film.frameAt(this.time);
    // Between two frames, one step back is the frame before.
    const back = count < 0 && frames[at].time < this.time ? 1 : 0;
    this.seek(frames[Math.max(0, Math.min(frames.length - 1, at + count + back))].time);
  }

  toggle() {
    if (this.playing) return this.pause();
    if (this.time >= this.film.end) this.time = this.film.start;
    this.playing = true;
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
    this.changed();
  }

  pause() {
    this.playing = false;
    this.changed();
  }

  tick(now) {
    if (!this.playing) return;
    const passed = Math.max(0, now - this.last) / 1000;
    this.last = now;
    this.time += passed * this.speed;
    if (this.time >= this.film.end) {
      this.time = this.film.end;
      this.playing = false;
    } else {
      requestAnimationFrame((next) => this.tick(next));
    }
    this.changed();
  }

  // Frames on both sides of now, and how far it is from the one to the other.
  moment() {
    const { frames } = this.film,
      from = this.film.frameAt(this.time),
      to = Math.min(from + 1, frames.length - 1);
    const gap = frames[to].time - frames[from].time;
    return { from, to, part: gap > 0 ? Math.max(0, Math.min(1, (this.time - frames[from].time) / gap)) : 0 };
  }
}
