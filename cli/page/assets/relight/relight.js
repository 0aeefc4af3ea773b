"use strict";
// Frames lit otherwise, from their layers of light: frame + sum over lights of (new colour - colour) x layer of unit
// light. With all settings as the document has them nothing is added, and a frame keeps its bits. Otherwise a value is
// that of the edited scene's frame but for the rounding of halves: of the frame, of the layers and of the result.

/** The bits of the halves nearest to float32 values, ties to even; finite values beyond their range become the largest. */
function toHalves(values, count, out) {
  const words = new Uint32Array(values.buffer, values.byteOffset, count), rounder = new Float32Array(1), rounded = new Uint32Array(rounder.buffer);
  for (let i = 0; i < count; ++i) {
    const word = words[i], magnitude = word & 0x7fffffff, sign = (word >>> 16) & 0x8000;
    if (magnitude >= 0x7f800000) {
      out[i] = sign | 0x7c00 | (magnitude > 0x7f800000 ? 0x200 : 0);
    } else if (magnitude < 0x38800000) {
      rounder[0] = Math.abs(values[i]) + 0.5;  // its last bit is the last bit of a half below 2^-14
      out[i] = sign | (rounded[0] - 0x3f000000);
    } else {
      const finite = Math.min(magnitude, 0x477fe000);
      out[i] = sign | ((finite - 0x38000000 + 0xfff + ((finite >>> 13) & 1)) >>> 13);
    }
  }
}

/** What the sliders of one control are set to. `stops` and `color` say what a light gives when it is on. */
class LightState {
  constructor(control) {
    const [setting] = control.settings, isOff = control.kind !== "shared" && setting !== undefined && Relight.product(setting).every((value) => value === 0);
    this.base = LightState.base(control);
    this.color = [...this.base.color];
    this.stops = 0;
    this.isMuted = isOff;
    this.wasMuted = isOff;
    this.isSolo = false;
  }

  /** Where exposure is 0: the document's values; those that are black are white, or 1, once the light is on. */
  static base({ kind, settings: [setting] }) {
    if (kind === "shared" || kind === "fixed") return { color: [1, 1, 1], intensity: 1 };
    const color = setting.color.value;
    return { color: color.some((value) => value > 0) ? color : [1, 1, 1], intensity: setting.intensity?.value || 1 };
  }

  isAtRest() {
    return this.stops === 0 && !this.isSolo && this.isMuted === this.wasMuted && this.color.every((value, i) => value === this.base.color[i]);
  }
}

class Relight {
  /** `lights`: LightLayers of the frame that is lit. */
  constructor(lights) {
    this.lights = lights;
    this.entry = lights.entry;
    this.controls = lights.controls;
    this.states = this.controls.map((control) => new LightState(control));
  }

  /** Colour times intensity in the document. */
  static product({ color, intensity }) {
    return color.value.map((value) => value * (intensity?.value ?? 1));
  }

  isAtRest() {
    return this.states.every((state) => state.isAtRest());
  }

  reset() {
    this.states = this.controls.map((control) => new LightState(control));
  }

  /** Whether a light gives light: of the lights that are solo, if there are any. */
  isOn(i) {
    const hasSolo = this.states.some((state) => state.isSolo), state = this.states[i];
    return hasSolo ? state.isSolo : !state.isMuted;
  }

  /** Linear RGB of a control in the document and as it is set. What no slider scales stays. */
  colors(i) {
    const control = this.controls[i], { kind, unit, settings: [setting] } = control, state = this.states[i];
    if (kind === "fixed") return { before: [1, 1, 1], after: [1, 1, 1] };
    const { base } = state, before = kind === "shared" ? [1, 1, 1] : Relight.product(setting).map((value, k) => unit[k] * value);
    if (state.isAtRest() && this.isOn(i) === !state.wasMuted) return { before, after: before };
    const after = state.color.map((value, k) => (this.isOn(i) ? unit[k] * (value * base.intensity * 2 ** state.stops) : 0));
    return { before, after };
  }

  /** For each layer that gives light before or after: its planes, and by what they are multiplied to make the frame as it
      is set (`all`) and to get there from the frame before (`change`). */
  weights() {
    return this.controls.flatMap(({ layers }, i) => {
      const { before, after } = this.colors(i);
      return layers.map((layer) => {
        const { scale } = this.lights.layers[layer];
        return { planes: this.lights.planesOf(layer), all: after.map((value) => value / scale), change: after.map((value, k) => (value - before[k]) / scale) };
      });
    });
  }

  /** The frame as it is set: `buffer` itself where nothing is. Both have the same planes. */
  applyTo(buffer) {
    const weights = this.weights();
    if (weights.every(({ change }) => change.every((value) => value === 0))) return buffer;
    const relit = Object.assign(Object.create(FrameBuffer.prototype), buffer, { planes: { ...buffer.planes } });
    ["R", "G", "B"].forEach((name, color) => {
      if (buffer.planes[name]) relit.planes[name] = Relight.plane(buffer.planes[name], weights, color);
    });
    return relit;
  }

  static plane(frame, weights, color) {
    const isHalf = frame instanceof Uint16Array, count = frame.length, block = Math.min(Relight.block, count);
    const out = new frame.constructor(frame), floats = isHalf ? null : new Float32Array(frame.buffer, frame.byteOffset, count);
    const delta = new Float64Array(block), all = new Float64Array(block), shown = new Float32Array(block), halves = new Uint16Array(block);
    const add = (sum, plane, factor, first, size) => {
      for (let i = 0; i < size; ++i) sum[i] += factor * halfValues[plane[first + i]];
    };
    for (let first = 0; first < count; first += block) {
      const size = Math.min(block, count - first);
      delta.fill(0);
      for (const { planes, change } of weights) if (change[color] !== 0) add(delta, planes[color], change[color], first, size);
      let isLess = false;
      for (let i = 0; i < size; ++i) {
        const value = isHalf ? halfValues[frame[first + i]] : floats[first + i];
        shown[i] = value + delta[i];
        isLess ||= shown[i] < value / 2;
      }
      if (isLess) {
        // Where most of the light goes, little is left of the frame's digits: what stays is added up instead.
        all.fill(0);
        for (const { planes, all: factors } of weights) if (factors[color] !== 0) add(all, planes[color], factors[color], first, size);
        for (let i = 0; i < size; ++i) {
          const value = isHalf ? halfValues[frame[first + i]] : floats[first + i];
          if (shown[i] < value / 2) shown[i] = all[i];
        }
      }
      if (isHalf) toHalves(shown, size, halves);
      const bits = isHalf ? halves : new Uint32Array(shown.buffer);
      for (let i = 0; i < size; ++i) if (delta[i] !== 0) out[first + i] = bits[i];
    }
    return out;
  }

  /** RFC 6902 operations on the look document that make this look from that of the frame. */
  operations() {
    return this.controls.flatMap((control, i) => control.settings.flatMap((setting) => this.operationsOf(control, i, setting)));
  }

  operationsOf(control, i, { color, intensity }) {
    const { before, after } = this.colors(i), state = this.states[i], { base } = state;
    if (before.every((value, k) => value === after[k])) return [];
    const isShared = control.kind === "shared", factor = this.isOn(i) ? 2 ** state.stops : 0;
    const newColor = isShared ? color.value.map((value, k) => value * state.color[k]) : state.color;
    const newIntensity = (isShared ? intensity?.value ?? 1 : base.intensity) * factor;
    const operation = ({ path, value }, wanted) => (JSON.stringify(value) === JSON.stringify(wanted) ? [] : [{ op: "replace", path, value: wanted }]);
    if (!intensity) return operation(color, newColor.map((value) => value * newIntensity));
    return [...(factor > 0 ? operation(color, newColor) : []), ...operation(intensity, newIntensity)];
  }

  /** A journal step that makes it: it starts from the step of the frame. Null: the way to the frame is too long. */
  step(name) {
    const { from, operations } = this.lights.start;
    if (operations === null) return null;
    return { name, from: from === 0 ? "base" : from, edit: [...operations, ...this.operations()] };
  }
}
Relight.block = 16384;  // pixels at a time
