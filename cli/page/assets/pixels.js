"use strict";
// The linear pixels of a run's frames, bit by bit those of its EXR files: tiles as OpenEXR packs them, each stored with
// the first frame that has it. They stand in the page, or in pixels/*.js beside it; of long runs only some frames.

/** Values of all half floats, by their bits. */
const halfValues = (() => {
  const values = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31, fraction = bits & 1023;
    let value = fraction * 2 ** -24;
    if (exponent === 31) value = fraction ? NaN : Infinity;
    else if (exponent > 0) value = (1024 + fraction) * 2 ** (exponent - 25);
    values[bits] = bits & 0x8000 ? -value : value;
  }
  return values;
})();

/** One frame: for each of R, G, B and A the bits of its values, [height * width]. */
class FrameBuffer {
  constructor(layout) {
    this.width = layout.width;
    this.height = layout.height;
    this.columns = Math.ceil(layout.width / layout.tile);
    this.tileCount = this.columns * Math.ceil(layout.height / layout.tile);
    this.sources = new Int32Array(this.tileCount).fill(-1);  // the entry that each tile is from
    this.planes = {};
    for (const { name, bytes } of layout.channels)
      if ("RGBA".includes(name))
        this.planes[name] = new (bytes === 2 ? Uint16Array : Uint32Array)(layout.width * layout.height);
  }

  /** The value of a channel at a pixel, as the file has it. */
  value(name, x, y) {
    const plane = this.planes[name];
    if (!plane) return name === "A" ? 1 : 0;
    if (plane instanceof Uint16Array) return halfValues[plane[y * this.width + x]];
    return new Float32Array(plane.buffer)[y * this.width + x];
  }
}

class RunFrames {
  /** `embedded`: a record [entry, tiles, sizes, base64] for each frame that brought tiles, or null when they are beside
      the page, several to a file. */
  constructor(layout, embedded, details) {
    Object.assign(this, { layout, embedded, details });
    this.starts = embedded ? embedded.map(([entry]) => entry) : layout.bundles ?? [];  // first entries of bundles
    this.bundles = new Map();  // promises of them by first entry, the latest used last
    this.bytesOf = new Map();
  }

  /** Makes `buffer` the frame of an entry: takes the tiles that it does not have yet. False: they are not in the page. */
  async fill(buffer, entry) {
    const wanted = await this.details.sources(entry, buffer.tileCount), tiles = [];
    if (!wanted) return false;
    for (let tile = 0; tile < wanted.length; ++tile)
      if (buffer.sources[tile] !== wanted[tile]) tiles.push(tile);
    await Promise.all(tiles.map(async (tile) => {
      const raw = await this.rawTile(tile, wanted[tile]);
      this.place(buffer, tile, raw);
      buffer.sources[tile] = wanted[tile];
    }));
    return true;
  }

  rect(tile) {
    const { width, height, tile: side } = this.layout, columns = Math.ceil(width / side);
    const x = (tile % columns) * side, y = Math.floor(tile / columns) * side;
    return { x, y, width: Math.min(side, width - x), height: Math.min(side, height - y) };
  }

  place(buffer, tile, raw) {
    const { x, y, width, height } = this.rect(tile);
    let offset = 0;
    for (let row = 0; row < height; ++row) {
      for (const { name, bytes } of this.layout.channels) {
        const plane = buffer.planes[name];
        if (plane) {
          const values = new plane.constructor(raw.buffer.slice(offset, offset + width * bytes));
          plane.set(values, (y + row) * this.layout.width + x);
        }
        offset += width * bytes;
      }
    }
  }

  async rawTile(tile, entry) {
    const { bytes, places } = (await this.bundle(entry)).get(entry), [offset, size] = places.get(tile);
    const { width, height } = this.rect(tile), packed = bytes.subarray(offset, offset + size);
    return beside.unpacked(packed, width * height * this.layout.channels.reduce((sum, { bytes: each }) => sum + each, 0));
  }

  /** The records of the bundle that an entry is in, by entry: their bytes, and offset and size of each tile. */
  bundle(entry) {
    let low = 0, high = this.starts.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.starts[middle] <= entry) low = middle + 1;
      else high = middle;
    }
    const start = this.starts[low - 1], bundle = this.bundles.get(start) ?? this.load(low - 1);
    this.bundles.delete(start);
    this.bundles.set(start, bundle);
    return bundle;
  }

  async load(number) {
    const start = this.starts[number];
    try {
      const records = this.embedded ? [this.embedded[number]] : await beside.load(beside.name("", start, this.layout));
      const bundle = new Map(records.map(([entry, tiles, sizes, base64]) => {
        const places = new Map();
        let offset = 0, i = 0;
        for (let k = 0; k < tiles.length; k += 2) {
          for (let tile = tiles[k]; tile < tiles[k] + tiles[k + 1]; ++tile) {
            places.set(tile, [offset, sizes[i]]);
            offset += sizes[i++];
          }
        }
        return [entry, { bytes: beside.bytes(base64), places }];
      }));
      this.forget(start, [...bundle.values()].reduce((sum, { bytes }) => sum + bytes.length, 0));
      return bundle;
    } catch (error) {
      this.bundles.delete(start);
      throw error;
    }
  }

  /** Of bundles that were not used for long, when there are too many with the one that has just come. */
  forget(newest, bytes) {
    this.bytesOf.set(newest, bytes);
    let total = [...this.bytesOf.values()].reduce((sum, each) => sum + each, 0);
    for (const start of [...this.bundles.keys()]) {
      if (total < RunFrames.mostBytes) break;
      if (start === newest || !this.bytesOf.has(start)) continue;
      total -= this.bytesOf.get(start);
      this.bytesOf.delete(start);
      this.bundles.delete(start);
    }
  }
}
RunFrames.mostBytes = 3e8;  // kept in memory, packed
