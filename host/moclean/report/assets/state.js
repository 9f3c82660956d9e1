// What the user is looking at: one frame, one joint, and how. Everything that draws listens.
(function (report) {
  "use strict";

  report.State = class {
    constructor(values) {
      this.values = values;
      this.listeners = [];
    }

    // listener(values, changed) is called after every change; `changed` has the names that did.
    listen(listener) { this.listeners.push(listener); }

    set(changes) {
      const changed = {};
      for (const [name, value] of Object.entries(changes))
        if (this.values[name] !== value) {
          this.values[name] = value;
          changed[name] = true;
        }
      if (Object.keys(changed).length === 0) return;
      for (const listener of this.listeners) listener(this.values, changed);
    }

    // To a frame within the take, stopping there.
    seek(frame, changes = {}) {
      const last = this.values.frames - 1;
      this.set({ frame: Math.max(0, Math.min(last, Math.round(frame))), playing: false, ...changes });
    }
  };
})(window.mocleanReport);
