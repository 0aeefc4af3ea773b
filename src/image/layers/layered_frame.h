// Frames with layers for compositing (--aovs). The layers are made from the scene as it is now, by a pass of their own
// over all of the image, whoever asks, and from the exact sums of light that a frame of Integrator::path is made of:
// so a replay's file is that of a full render, byte for byte.
#pragma once
#include "cache/residency/residency.h"
#include "frame/changed_pixels.h"
#include "frame/frame_file.h"
#include "image/layers/half_light.h"
#include "image/render.h"

namespace relook {

struct LayeredFrame {
  const Scene& scene;
  const ViewOptions& view;
  const Frame& frame;            // of that scene
  const ChangedPixels& changed;  // since the frame before
  PixelFormat format;            // of R, G, B and A; layers are float32
  const std::vector<PackedSums>* light_sums = nullptr;  // of path: of the frame, [tiles]; otherwise not looked at
  Residency* residency = nullptr;                       // of `light_sums`; null: all are in memory
  /// By tile: a number that is another one whenever the sums are those of other samples, above 0; null: not known.
  const std::vector<std::uint32_t>* versions = nullptr;
  KeptHalves* halves = nullptr;  // from frames before, of the same versions; null: nothing is kept
};

/// The file: an OpenEXR frame as encode_exr() writes it, with the channels of FrameLayers.
[[nodiscard]] Bytes encode_layered_exr(const LayeredFrame& frame, const FrameMeta& meta, const Progress& progress = {});

}  // namespace relook
