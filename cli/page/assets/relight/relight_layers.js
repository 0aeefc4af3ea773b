"use strict";
// The layers of light of a run's frames, which relighting adds up anew: from pixels/relight_*.js beside the page, loaded
// when they are asked for. A tile stands with the first frame that has it.

function relook_relight(entry, records) {
  beside.arrive("relight_", entry, records);
}

/** One frame's: planes of half bits, one a channel ("light_Key.R"), and what the look document says of its lights. */
class LightLayers {
  constructor(layout, channels) {
    this.channels = channels;
    this.planes = channels.map(() => new Uint16Array(layout.width * layout.height));
    this.sources = new Int32Array(Math.ceil(layout.width / layout.tile) * Math.ceil(layout.height / layout.tile)).fill(-1);
    this.entry = -1;
    this.layers = [];  // {name, scale}: a plane is what white light of `scale` gives
    this.controls = [];
    this.start = null;  // where a journal step would start
  }

  /** The planes of a layer: R, G, B. */
  planesOf(layer) {
    return ["R", "G", "B"].map((color) => this.planes[this.channels.indexOf(`${this.layers[layer].name}.${color}`)]);
  }
}

class RunLights {
  /** `index`: {bundles: first entries of the files, entries: those with layers, as runs [first, count, ...]}, or null. */
  constructor(layout, index) {
    Object.assign(this, { layout, index, bundles: new Map(), last: null, loading: Promise.resolve() });
  }

  has(entry) {
    const runs = this.index?.entries ?? [];
    for (let i = 0; i < runs.length; i += 2) if (entry >= runs[i] && entry < runs[i] + runs[i + 1]) return true;
    return false;
  }

  /** The layers of an entry's frame, in the memory of those asked for before. Requires: it has some. */
  of(entry) {
    this.loading = this.loading.catch(() => {}).then(() => this.load(entry));
    return this.loading;
  }

  async load(entry) {
    if (this.last?.entry === entry) return this.last;
    const record = (await this.bundle(entry)).get(entry);
    const { layers, controls, start, channels, sources } = JSON.parse(new TextDecoder().decode(await beside.inflated(beside.bytes(record.head))));
    const isAlike = this.last?.channels.join() === channels.join();
    const lights = isAlike ? this.last : new LightLayers(this.layout, channels);
    this.last = lights;
    lights.entry = -1;
    const wanted = [];
    for (let i = 0, tile = 0; i < sources.length; i += 2)
      for (let k = 0; k < sources[i]; ++k, ++tile) if (lights.sources[tile] !== sources[i + 1]) wanted.push([tile, sources[i + 1]]);
    for (const [tile, source] of wanted) {
      lights.sources[tile] = -1;
      await this.take(lights, tile, source);
      lights.sources[tile] = source;
    }
    return Object.assign(lights, { entry, layers, controls, start });
  }

  async take(lights, tile, source) {
    const { bytes, places } = (await this.bundle(source)).get(source), [offset, size] = places.get(tile);
    const { width: imageWidth, height: imageHeight, tile: side } = this.layout, columns = Math.ceil(imageWidth / side);
    const left = (tile % columns) * side, top = Math.floor(tile / columns) * side;
    const width = Math.min(side, imageWidth - left), height = Math.min(side, imageHeight - top);
    const raw = await beside.unpacked(bytes.subarray(offset, offset + size), 2 * width * height * lights.planes.length);
    const values = new Uint16Array(raw.buffer);
    for (let row = 0, from = 0; row < height; ++row)
      for (const plane of lights.planes) {
        plane.set(values.subarray(from, from + width), (top + row) * imageWidth + left);
        from += width;
      }
  }

  /** The records of the file that an entry is in, by entry; the last few files stay in memory. */
  async bundle(entry) {
    const start = this.index.bundles.findLast((first) => first <= entry);
    const bundle = this.bundles.get(start) ?? this.read(start);
    this.bundles.delete(start);
    this.bundles.set(start, bundle);
    let total = 0;
    for (const other of [...this.bundles.keys()].reverse()) {
      total += (await this.bundles.get(other)?.catch(() => null))?.size ?? 0;
      if (total > RunLights.mostBytes && other !== start) this.bundles.delete(other);
    }
    return (await bundle).records;
  }

  read(start) {
    const bundle = beside.load(beside.name("relight_", start, this.layout)).then((list) => {
      let size = 0;
      const records = new Map(list.map(([entry, head, tiles, sizes, base64]) => {
        const places = new Map(), bytes = beside.bytes(base64);
        for (let k = 0, i = 0, offset = 0; k < tiles.length; k += 2)
          for (let tile = tiles[k]; tile < tiles[k] + tiles[k + 1]; ++tile) {
            places.set(tile, [offset, sizes[i]]);
            offset += sizes[i++];
          }
        size += bytes.length;
        return [entry, { head, bytes, places }];
      }));
      return { records, size };
    });
    bundle.catch(() => this.bundles.delete(start));
    return bundle;
  }
}
RunLights.mostBytes = 3e8;  // kept in memory, packed
