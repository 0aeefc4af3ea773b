"use strict";
// How light becomes display values: curves by their formulas, the lattice of an OpenColorIO view that the program has
// baked (page/view_lut.h), false colours. All tables are by the bits of a half; display.js and display_gl.js share them,
// so that both show the same.

const curveBits = { float: new Float32Array(1) };
curveBits.uint = new Uint32Array(curveBits.float.buffer);

/** The bits of the nearest half of a float32; display_gl.js has it in GLSL. */
function halfBitsOf(value) {
  curveBits.float[0] = value;
  const bits = curveBits.uint[0], sign = (bits >>> 16) & 0x8000, magnitude = bits & 0x7fffffff;
  if (magnitude > 0x7f800000) return 0x7e00;
  if (magnitude >= 0x47800000) return sign | 0x7c00;
  if (magnitude < 0x38800000) return sign | Math.floor(Math.abs(value) * 16777216 + 0.5);
  return sign | ((magnitude - 0x38000000 + 0xfff + ((magnitude >>> 13) & 1)) >>> 13);
}

/** IEC 61966-2-1. */
function srgbEncoded(value) {
  return value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;
}

/** J. Hable, Filmic Tonemapping Operators, 2010 ("Uncharted 2"), with its exposure of 2 and its white of 11.2. */
function filmicShown(value) {
  const part = (x) => (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
  return part(2 * Math.max(0, value)) / part(11.2);
}

/** Khronos PBR Neutral Tone Mapper, specification 1.0, 2024: base colours stay up to 0.8 less the 0.04 of a Fresnel
    reflection, beyond they are compressed towards white. `color`: linear R, G, B, replaced. */
function neutralShown(color) {
  for (let i = 0; i < 3; ++i) color[i] = Math.max(0, color[i]);
  const least = Math.min(color[0], color[1], color[2]), offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
  const start = 0.8 - 0.04, room = 1 - start, peak = Math.max(color[0], color[1], color[2]) - offset;
  for (let i = 0; i < 3; ++i) color[i] -= offset;
  if (peak < start) return;
  const shown = 1 - room * room / (peak + room - start), toWhite = 1 - 1 / (0.15 * (peak - shown) + 1);
  for (let i = 0; i < 3; ++i) {
    const value = color[i] * shown / peak;
    color[i] = value + (shown - value) * toWhite;
  }
}

/** `shown`: of one channel, from linear light to linear light of the display, where channels do not depend on each
    other. `white`: the light from which on the display is white; Infinity where it is never. */
const curves = {
  srgb: { id: 0, name: "sRGB", white: 1, shown: (value) => value },
  filmic: { id: 0, name: "Filmic", white: 5.6, shown: filmicShown },
  neutral: { id: 1, name: "Neutral", white: Infinity },
  view: { id: 2, name: "View of previews", white: Infinity },  // only with a lattice
};

/** What `RunReport` writes of a view: page/view_lut.h. */
class ViewLut {
  static async of(data) {
    const bytes = await beside.inflated(beside.bytes(data.codes)), count = bytes.length / 2, side = data.size ** 3;
    const lut = Object.assign(new ViewLut(), data, { codes: new Uint16Array(4 * side) });  // R, G, B and 0, for textures
    for (let i = 0, code = 0; i < count; ++i) {
      if (i % side === 0) code = 0;
      code = (code + bytes[i] + 256 * bytes[count + i]) & 0xffff;
      lut.codes[4 * (i % side) + Math.floor(i / side)] = code;
    }
    lut.stops = Math.log2(1 + data.most / data.offset);
    return lut;
  }

  /** Linear R, G, B become display values, 0..1 where they are codes. Kasson et al., 1995: between the corners of a
      tetrahedron, along the axes, that with the largest rest first. */
  show(color) {
    const { size, codes } = this, strides = [4, 4 * size, 4 * size * size], rest = [0, 0, 0];
    let corner = 0;
    for (let axis = 0; axis < 3; ++axis) {
      const light = Math.min(this.most, Math.max(0, color[axis]));
      const place = Math.log2(1 + light / this.offset) / this.stops * (size - 1), cell = Math.min(Math.floor(place), size - 2);
      rest[axis] = place - cell;
      corner += cell * strides[axis];
    }
    const first = rest[0] >= rest[1] ? (rest[0] >= rest[2] ? 0 : 2) : (rest[1] >= rest[2] ? 1 : 2);
    const last = rest[2] <= rest[1] ? (rest[2] <= rest[0] ? 2 : 0) : (rest[1] < rest[0] ? 1 : 0);
    const middle = 3 - first - last, end = corner + strides[0] + strides[1] + strides[2];
    const second = corner + strides[first], third = end - strides[last];
    const weights = [1 - rest[first], rest[first] - rest[middle], rest[middle] - rest[last], rest[last]];
    for (let i = 0; i < 3; ++i) {
      const code = weights[0] * codes[corner + i] + weights[1] * codes[second + i] + weights[2] * codes[third + i] + weights[3] * codes[end + i];
      color[i] = this.low + code * (this.high - this.low) / 65535;
    }
  }
}

/** Rec.709. */
const lumaWeights = [0.2126, 0.7152, 0.0722];
const middleGrey = 0.18;
const mostLight = 1e6;  // beyond nothing changes; infinity is this

/** Light that can be shown: no number is none. */
function boundedLight(light) {
  return light > -mostLight ? Math.min(light, mostLight) : Number.isNaN(light) ? 0 : -mostLight;
}

/** Stops over middle grey. */
function stopsOf(light) {
  return Math.log2(Math.max(light, 1e-9) / middleGrey);
}

/** Colours of the stops -7 to 7 over middle grey, codes of R, G and B. */
const falseColors = [
  [24, 0, 36], [66, 12, 110], [52, 44, 168], [28, 92, 208], [0, 134, 196], [0, 156, 140], [62, 160, 76], [128, 128, 128],
  [178, 178, 84], [232, 198, 46], [244, 148, 28], [236, 92, 36], [214, 34, 66], [246, 130, 200], [255, 255, 255],
];

/** The colour of a light: bands a stop wide, with edges of a sixteenth. */
function falseColor(light, codes) {
  const place = Math.min(14, Math.max(0, stopsOf(light) + 7)), band = Math.min(13, Math.floor(place));
  const part = Math.min(1, Math.max(0, (place - band - 0.5) * 16 + 0.5));
  for (let i = 0; i < 3; ++i) codes[i] = falseColors[band][i] + (falseColors[band + 1][i] - falseColors[band][i]) * part;
}

/** Marks over the picture; what they are called. */
const clippingMarks = {
  above: { color: [255, 0, 0], name: "above display white" },
  below: { color: [0, 72, 255], name: "below zero" },
  undefined: { color: [255, 0, 255], name: "no number" },
};

/** Tables by the bits of a half, for a curve and a gain: what all painting and all scopes look values up in. */
class LightTables {
  constructor() {
    this.light = new Float32Array(65536);  // times the gain; no number: 0
    this.exposed = new Uint8ClampedArray(65536);  // codes of light, by the curve, or by sRGB
    this.plain = new Uint8ClampedArray(65536);  // codes of the half itself
  }

  /** Makes them those of a curve; true when anything is new. */
  update(curve, gain) {
    const isOther = curve !== this.curve, shown = curve.shown ?? ((value) => value);
    if (!isOther && gain === this.gain) return false;
    const code = (value) => 255 * srgbEncoded(shown(value));
    for (let i = 0; i < 65536; ++i) {
      this.light[i] = boundedLight(Math.fround(halfValues[i] * gain));
      this.exposed[i] = code(this.light[i]);
    }
    for (let i = 0; isOther && i < 65536; ++i) this.plain[i] = code(boundedLight(halfValues[i]));
    Object.assign(this, { curve, gain });
    return true;
  }
}
