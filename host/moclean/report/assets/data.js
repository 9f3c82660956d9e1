// The take as the page holds it: 16-bit codes, decoded once into typed arrays, read by value.
(function (report) {
  "use strict";

  const missing = -32768;
  const labels = { noisy: "Noisy", clean: "Clean", truth: "Truth" };

  function bytesOf(base64) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return bytes;
  }

  // A matrix: value(row, column) is NaN where it is missing.
  class Samples {
    constructor(record) {
      const bytes = new DataView(bytesOf(record.codes).buffer);
      this.codes = new Int16Array(bytes.byteLength / 2);
      for (let i = 0; i < this.codes.length; ++i) this.codes[i] = bytes.getInt16(2 * i, true);
      this.offset = record.offset;
      this.step = record.step;
      this.columns = record.step.length;
      this.rows = this.codes.length / this.columns;
    }

    value(row, column) {
      const code = this.codes[row * this.columns + column];
      return code === missing ? NaN : this.offset[column] + this.step[column] * code;
    }
  }

  class Take {
    constructor(record) {
      Object.assign(this, record);
      this.clips = Object.keys(record.clips).map((key) => ({
        key, label: labels[key], samples: new Samples(record.clips[key]),
      }));
      this.corrections = new Samples(record.corrections);
      this.perFrame = new Samples(record.figures.perFrame);
      this.marks = bytesOf(record.marks);
      this.sigma = record.sigma ? new Samples(record.sigma) : null;
      this.columns = this.clips[0].samples.columns;
      this.points = this.joints.map((joint, index) => index)
        .filter((index) => this.joints[index].columns === 3);
      this.bones = this.parents.map((parent, joint) => [parent, joint]).filter(([parent]) => parent >= 0);
    }

    clip(key) { return this.clips.find((clip) => clip.key === key); }

    // The joint's place, or null in a gap. Bodies stand along y; with z up they are turned.
    position(clip, frame, joint, up) {
      const first = this.joints[joint].first;
      const x = clip.samples.value(frame, first);
      const y = clip.samples.value(frame, first + 1);
      const z = clip.samples.value(frame, first + 2);
      if (Number.isNaN(x + y + z)) return null;
      return up === "z" ? [x, z, -y] : [x, y, z];
    }

    isMarked(frame, column) {
      const bit = frame * this.columns + column;
      return (this.marks[bit >> 3] >> (bit & 7)) & 1;
    }

    // Whether a sample was missing and was filled, or is still missing ("left").
    isFilled(frame, column) { return this.isMissing("noisy", frame, column) && !this.isMissing("clean", frame, column); }
    isLeft(frame, column) { return this.isMissing("clean", frame, column); }
    isMissing(key, frame, column) { return Number.isNaN(this.clip(key).samples.value(frame, column)); }

    hasAny(frame, joint, test) {
      const { first, columns } = this.joints[joint];
      for (let c = first; c < first + columns; ++c) if (test(frame, c)) return true;
      return false;
    }

    isJointMarked(frame, joint) { return this.hasAny(frame, joint, (f, c) => this.isMarked(f, c)); }
    isJointFilled(frame, joint) { return this.hasAny(frame, joint, (f, c) => this.isFilled(f, c)); }
    isJointLeft(frame, joint) { return this.hasAny(frame, joint, (f, c) => this.isLeft(f, c)); }

    // The colour that stands out on a joint of a body in a frame; null for one that does not: what was wrong shows in
    // the noisy body, what was filled in the clean one. Both drawings of the bodies ask here.
    highlight(key, frame, joint) {
      if (key === "noisy" && this.isJointMarked(frame, joint)) return "mark";
      if (key === "clean" && this.isJointFilled(frame, joint)) return "filled";
      return null;
    }

    highlights(frame) {
      return this.clips.map(({ key }) => this.points.filter((joint) => this.highlight(key, frame, joint)).length);
    }

    // Distance of the joint in one clip from the same in another; NaN in a gap of either.
    distance(clip, other, frame, joint) {
      const { first, columns } = this.joints[joint];
      let squares = 0;
      for (let c = first; c < first + columns; ++c)
        squares += (clip.samples.value(frame, c) - other.samples.value(frame, c)) ** 2;
      return Math.sqrt(squares);
    }

    time(frame) { return this.rate > 0 ? `${(frame / this.rate).toFixed(2)} s` : ""; }
  }

  report.Take = Take;
})(window.mocleanReport = window.mocleanReport || {});
