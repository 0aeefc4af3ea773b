"use strict";
// Shows frames by WebGL 2: their bits are textures, kept from one painting to the next, and one shader has all settings,
// so that a slider costs a draw. What it computes is what PixelPainter (display.js) does.

const glSource = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
precision highp usampler3D;
uniform usampler2D R, G, B, A;  // bits of halves or of float32
uniform usampler2D tables;      // 256 x 512: codes by the bits of a half, exposed; below as they are
uniform usampler3D lattice;
uniform bool isHalf, hasAlpha, falseColor, clipping;
uniform int curve, channel;     // 0: by tables, 1: neutral, 2: the lattice; 0 to 3: R, G, B, A, 4: luma, 5: all
uniform float gain, white, offset, stops, most, low, high;
uniform vec3 ramp[15], marks[3], weights;
out vec4 shown;

const float kMost = ${mostLight.toFixed(1)};

bool isNumber(uint bits) {
  return isHalf ? (bits & 0x7fffu) <= 0x7c00u : (bits & 0x7fffffffu) <= 0x7f800000u;
}
float valueOf(uint bits) {
  if (!isNumber(bits)) return 0.0;
  if (!isHalf) return uintBitsToFloat(bits);
  uint exponent = (bits >> 10) & 31u, fraction = bits & 1023u;
  float value = exponent == 0u ? float(fraction) * 5.9604644775390625e-8
    : exponent == 31u ? uintBitsToFloat(0x7f7fffffu) : uintBitsToFloat(((exponent + 112u) << 23) | (fraction << 13));
  return (bits & 0x8000u) != 0u ? -value : value;
}
float lightOf(uint bits) {
  return clamp(valueOf(bits) * gain, -kMost, kMost);
}
uint halfBitsOf(float value) {
  uint bits = floatBitsToUint(value), sign = (bits >> 16) & 0x8000u, magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u) return 0x7e00u;
  if (magnitude >= 0x47800000u) return sign | 0x7c00u;
  if (magnitude < 0x38800000u) return sign | uint(floor(abs(value) * 16777216.0 + 0.5));
  return sign | ((magnitude - 0x38000000u + 0xfffu + ((magnitude >> 13) & 1u)) >> 13);
}
float plainCode(float value) {
  uint bits = halfBitsOf(value);
  return float(texelFetch(tables, ivec2(bits & 255u, 256u + (bits >> 8)), 0).r);
}
float exposedCode(uint bits, float light) {
  return isHalf ? float(texelFetch(tables, ivec2(bits & 255u, bits >> 8), 0).r) : plainCode(light);
}
vec3 falseColorOf(float light) {
  float place = clamp(log2(max(light, 1e-9) / ${middleGrey}) + 7.0, 0.0, 14.0), band = min(13.0, floor(place));
  return mix(ramp[int(band)], ramp[int(band) + 1], clamp((place - band - 0.5) * 16.0 + 0.5, 0.0, 1.0));
}
vec3 neutral(vec3 color) {
  color = max(color, 0.0);
  float least = min(color.r, min(color.g, color.b)), shift = least < 0.08 ? least - 6.25 * least * least : 0.04;
  float start = 0.8 - 0.04, room = 1.0 - start, peak = max(color.r, max(color.g, color.b)) - shift;
  color -= shift;
  if (peak < start) return color;
  float top = 1.0 - room * room / (peak + room - start);
  return mix(color * top / peak, vec3(top), 1.0 - 1.0 / (0.15 * (peak - top) + 1.0));
}
vec3 corner(ivec3 place) {
  return vec3(texelFetch(lattice, place, 0).rgb);
}
vec3 viewed(vec3 color) {
  int size = textureSize(lattice, 0).x;
  vec3 place = log2(1.0 + clamp(color, 0.0, most) / offset) / stops * float(size - 1);
  ivec3 cell = min(ivec3(place), ivec3(size - 2));
  vec3 rest = place - vec3(cell);
  int first = rest.r >= rest.g ? (rest.r >= rest.b ? 0 : 2) : (rest.g >= rest.b ? 1 : 2);
  int last = rest.b <= rest.g ? (rest.b <= rest.r ? 2 : 0) : (rest.g < rest.r ? 1 : 0);
  ivec3 step1 = ivec3(first == 0, first == 1, first == 2), step3 = ivec3(last == 0, last == 1, last == 2);
  float most1 = dot(rest, vec3(step1)), least1 = dot(rest, vec3(step3)), middle = dot(rest, vec3(1 - step1 - step3));
  vec3 code = (1.0 - most1) * corner(cell) + (most1 - middle) * corner(cell + step1)
    + (middle - least1) * corner(cell + 1 - step3) + least1 * corner(cell + 1);
  return floor(clamp(low + code * ((high - low) / 65535.0), 0.0, 1.0) * 255.0 + 0.5);
}
void main() {
  ivec2 place = ivec2(int(gl_FragCoord.x), textureSize(R, 0).y - 1 - int(gl_FragCoord.y));
  if (channel == 3) {
    float alpha = hasAlpha ? valueOf(texelFetch(A, place, 0).r) : 1.0;
    shown = vec4(vec3(floor(clamp(alpha, 0.0, 1.0) * 255.0 + 0.5) / 255.0), 1.0);
    return;
  }
  uvec3 bits = uvec3(texelFetch(R, place, 0).r, texelFetch(G, place, 0).r, texelFetch(B, place, 0).r);
  if (channel < 3) bits = uvec3(channel == 0 ? bits.r : channel == 1 ? bits.g : bits.b);
  vec3 light = vec3(lightOf(bits.r), lightOf(bits.g), lightOf(bits.b)), color = light;
  float peak = max(light.r, max(light.g, light.b)), least = min(light.r, min(light.g, light.b));
  if (falseColor) {
    color = falseColorOf(channel < 3 ? peak : dot(light, weights));
  } else if (curve == 0 && channel != 4) {
    color = vec3(exposedCode(bits.r, light.r), exposedCode(bits.g, light.g), exposedCode(bits.b, light.b));
  } else {
    if (channel == 4) color = vec3(dot(light, weights));
    if (curve == 2) color = viewed(color);
    else {
      if (curve == 1) color = neutral(color);
      color = vec3(plainCode(color.r), plainCode(color.g), plainCode(color.b));
    }
  }
  if (clipping) {
    bool isWhite = curve == 2 && !falseColor && max(color.r, max(color.g, color.b)) >= 255.0;
    if (!isNumber(bits.r) || !isNumber(bits.g) || !isNumber(bits.b)) color = marks[2];
    else if (least < 0.0) color = marks[1];
    else if (peak > white || isWhite) color = marks[0];
  }
  shown = vec4(color / 255.0, 1.0);
}`;

class GlPainter {
  /** Null without WebGL 2; where that has no graphics processor, too, unless `isForced`: tables are quicker then. */
  static make(isForced) {
    try {
      const canvas = document.createElement("canvas");
      const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false, failIfMajorPerformanceCaveat: !isForced });
      return gl && (isForced || !GlPainter.isSlow(gl)) ? new GlPainter(canvas, gl) : null;
    } catch (error) {
      console.info(`WebGL is not used: ${error.message}`);
      return null;
    }
  }

  /** Whether a program draws instead of a graphics processor. */
  static isSlow(gl) {
    const info = gl.getExtension("WEBGL_debug_renderer_info");
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  }

  constructor(canvas, gl) {
    Object.assign(this, { canvas, gl, frames: new Map(), lattice: null });
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, GlPainter.corners], [gl.FRAGMENT_SHADER, glSource]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    this.uniforms = new Proxy({}, { get: (found, name) => (found[name] ??= gl.getUniformLocation(program, name)) });
    this.units = { R: 0, G: 1, B: 2, A: 3, tables: 4, lattice: 5 };
    for (const [name, unit] of Object.entries(this.units)) gl.uniform1i(this.uniforms[name], unit);
    gl.uniform3fv(this.uniforms.ramp, falseColors.flat());
    gl.uniform3fv(this.uniforms.marks, Object.values(clippingMarks).flatMap(({ color }) => color));
    gl.uniform3fv(this.uniforms.weights, lumaWeights);
    this.tables = this.texture(this.units.tables);
    this.texture(this.units.A);  // for frames without alpha
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R16UI, 1, 1, 0, gl.RED_INTEGER, gl.UNSIGNED_SHORT, new Uint16Array(1));
    this.largest = gl.getParameter(gl.MAX_TEXTURE_SIZE);
    canvas.addEventListener("webglcontextlost", () => { this.isLost = true; });
  }

  texture(unit, target = this.gl.TEXTURE_2D) {
    const { gl } = this, texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(target, texture);
    gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
  }

  /** False: it cannot. */
  paint(buffer, look, canvas) {
    if (!this.draw(buffer, look)) return false;
    Object.assign(canvas, { width: buffer.width, height: buffer.height });
    canvas.getContext("2d").drawImage(this.canvas, 0, 0);
    return true;
  }

  /** As CanvasPainter.codes(), or null: it cannot. */
  codes(buffer, look) {
    if (!this.draw(buffer, look)) return null;
    const { gl } = this, codes = new Uint8ClampedArray(4 * buffer.width * buffer.height);
    gl.readPixels(0, 0, buffer.width, buffer.height, gl.RGBA, gl.UNSIGNED_BYTE, codes);
    return { codes, isUpsideDown: true };
  }

  draw(buffer, look) {
    const { gl, uniforms, canvas } = this, { width, height } = buffer;
    if (this.isLost || gl.isContextLost() || Math.max(width, height) > this.largest) return false;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    this.takeFrame(buffer);
    this.takeTables(look.tables);
    this.takeLattice(look);
    gl.viewport(0, 0, width, height);
    for (const name of ["falseColor", "clipping"]) gl.uniform1i(uniforms[name], look[name] ? 1 : 0);
    gl.uniform1i(uniforms.isHalf, buffer.planes.R instanceof Uint16Array ? 1 : 0);
    gl.uniform1i(uniforms.hasAlpha, buffer.planes.A ? 1 : 0);
    gl.uniform1i(uniforms.curve, look.curve.id);
    gl.uniform1i(uniforms.channel, ["R", "G", "B", "A", "luma", "rgb"].indexOf(look.channel));
    gl.uniform1f(uniforms.gain, look.gain);
    gl.uniform1f(uniforms.white, Math.min(look.curve.white, 2 * mostLight));
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    return gl.getError() === gl.NO_ERROR;
  }

  /** The textures of a frame; those of other pixels only when it has changed. */
  takeFrame(buffer) {
    const { gl } = this, state = `${buffer.version ?? 0} ${buffer.sources.join()}`;
    let frame = this.frames.get(buffer);
    this.frames.delete(buffer);
    if (!frame) {
      frame = { textures: Object.fromEntries(Object.keys(buffer.planes).map((name) => [name, this.texture(this.units[name])])) };
      for (const old of [...this.frames.keys()].slice(0, -2)) this.forget(old);
    }
    this.frames.set(buffer, frame);  // the one used last is the last
    for (const [name, texture] of Object.entries(frame.textures)) {
      gl.activeTexture(gl.TEXTURE0 + this.units[name]);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      if (frame.state === state) continue;
      const plane = buffer.planes[name], isHalf = plane instanceof Uint16Array;
      gl.texImage2D(gl.TEXTURE_2D, 0, isHalf ? gl.R16UI : gl.R32UI, buffer.width, buffer.height, 0, gl.RED_INTEGER,
        isHalf ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT, plane);
    }
    frame.state = state;
  }

  forget(buffer) {
    for (const texture of Object.values(this.frames.get(buffer).textures)) this.gl.deleteTexture(texture);
    this.frames.delete(buffer);
  }

  takeTables(tables) {
    const { gl } = this, state = `${tables.curve.name} ${tables.gain}`;
    if (state === this.tablesState) return;
    gl.activeTexture(gl.TEXTURE0 + this.units.tables);
    gl.bindTexture(gl.TEXTURE_2D, this.tables);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8UI, 256, 512, 0, gl.RED_INTEGER, gl.UNSIGNED_BYTE, null);
    for (const [row, codes] of [[0, tables.exposed], [256, tables.plain]])
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, row, 256, 256, gl.RED_INTEGER, gl.UNSIGNED_BYTE, new Uint8Array(codes.buffer));
    this.tablesState = state;
  }

  takeLattice({ lut }) {
    const { gl, uniforms } = this;
    if (this.lattice && this.lut === lut) return;
    this.lattice ??= this.texture(this.units.lattice, gl.TEXTURE_3D);
    this.lut = lut;
    const { size, codes } = lut ?? { size: 1, codes: new Uint16Array(4) };
    gl.activeTexture(gl.TEXTURE0 + this.units.lattice);
    gl.bindTexture(gl.TEXTURE_3D, this.lattice);
    gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGBA16UI, size, size, size, 0, gl.RGBA_INTEGER, gl.UNSIGNED_SHORT, codes);
    for (const name of ["offset", "stops", "most", "low", "high"]) gl.uniform1f(uniforms[name], lut?.[name] ?? 1);
  }
}
/** A triangle over all of it. */
GlPainter.corners = `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`;
