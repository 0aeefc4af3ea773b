"use strict";
// Data scripts beside the page, pixels/*.js, and the details of steps, which are in one of them or in the page.

const beside = {
  waiting: new Map(),  // by file

  /** What a file beside the page hands over to one of the two functions below. */
  load(file) {
    return new Promise((resolve, reject) => {
      beside.waiting.set(file, resolve);
      const script = document.createElement("script");
      script.onload = () => script.remove();
      script.onerror = () => reject(new Error(`${file} is not beside this page`));
      script.src = file;
      document.head.append(script);
    });
  },

  name(kind, number, layout) {
    return `pixels/${kind}${String(number).padStart(5, "0")}_${layout.page}.js`;
  },

  arrive(kind, number, data) {
    const start = `pixels/${kind}${String(number).padStart(5, "0")}_`;
    for (const [file, resolve] of beside.waiting) {
      if (!file.startsWith(start)) continue;
      beside.waiting.delete(file);
      resolve(data);
    }
  },

  bytes(base64) {
    const binary = atob(base64), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
    return bytes;
  },

  async inflated(bytes) {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  },

  /** A tile's bytes from a chunk of OpenEXR's ZIP, of its own memory: inflate, sums, bytes put back in turn. */
  async unpacked(packed, rawSize) {
    if (packed.length === rawSize) return packed.slice();
    const split = await beside.inflated(packed), raw = new Uint8Array(rawSize), evenSize = (rawSize + 1) >> 1;
    let sum = split[0];
    raw[0] = sum;
    for (let i = 1; i < rawSize; ++i) {
      sum = (sum + split[i] - 128) & 255;
      raw[i < evenSize ? 2 * i : 2 * (i - evenSize) + 1] = sum;
    }
    return raw;
  },
};

function relook_pixels(entry, records) {
  beside.arrive("", entry, records);
}

function relook_steps(chunk, text) {
  beside.arrive("steps_", chunk, text);
}

/** What the page shows of one step at a time, and the tiles that its frame brought; in chunks of `layout.chunk`. */
class StepDetails {
  /** `embedded`: the chunks, or null when they are beside the page. */
  constructor(layout, embedded) {
    this.layout = layout;
    this.chunks = new Map((embedded ?? []).map((chunk, i) => [i, Promise.resolve(chunk)]));
  }

  chunk(number) {
    if (!this.chunks.has(number)) {
      const chunk = beside.load(beside.name("steps_", number, this.layout))
        .then((text) => beside.inflated(beside.bytes(text)))
        .then((bytes) => JSON.parse(new TextDecoder().decode(bytes)));
      chunk.catch(() => this.chunks.delete(number));
      this.chunks.set(number, chunk);
    }
    return this.chunks.get(number);
  }

  async of(entry) {
    const chunk = await this.chunk(Math.floor(entry / this.layout.chunk));
    return chunk.entries[entry % this.layout.chunk];
  }

  /** The entry that each tile of a frame is from, -1 for none; null when the page does not have the frame's pixels. */
  async sources(entry, tileCount) {
    const { entries, sources: runs } = await this.chunk(Math.floor(entry / this.layout.chunk));
    const place = entry % this.layout.chunk, sources = new Int32Array(tileCount).fill(-1);
    if (!entries[place].tiles) return null;
    let tile = 0;
    for (let i = 0; i < runs.length; i += 2) {
      sources.fill(runs[i + 1], tile, tile + runs[i]);
      tile += runs[i];
    }
    for (let i = 0; i <= place; ++i) {
      const tiles = entries[i].tiles ?? [];
      for (let k = 0; k < tiles.length; k += 2) sources.fill(entry - place + i, tiles[k], tiles[k] + tiles[k + 1]);
    }
    return sources;
  }
}
