// One step of a replay: edit the scene state, find what the change can reach, update ray trees and colours there and
// nowhere else (paper 2.1, 2.2). The frame afterwards equals render() of the edited scene, bit for bit.
#pragma once
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "cache/residency/residency.h"
#include "cache/stored_tunnels.h"
#include "edit/scene_history.h"
#include "frame/image.h"
#include "image/regions.h"
#include "replay/step_result.h"
#include "scene/compile/state.h"

namespace relook {

struct ParameterSet;

class Replayer {
 public:
  /// Takes over a state and the image rendered from it (by preprocess() or from a cache). `residency`: with which the
  /// cache was read, or with no pieces yet; null: no limit. `tunnels`: of the image, used if they are as the options
  /// say.
  Replayer(SceneState state, Image image, const RegionOptions& options = {},
           std::unique_ptr<Residency> residency = nullptr, std::shared_ptr<StoredTunnels> tunnels = nullptr);
  ~Replayer();
  Replayer(Replayer&&) noexcept;

  [[nodiscard]] const SceneState& state() const;
  [[nodiscard]] const Image& image() const;
  /// As StoredImage has them.
  [[nodiscard]] const std::vector<std::uint32_t>& sum_versions() const;
  [[nodiscard]] Resident resident() const;
  /// Number of stored segments: rays and shadow segments of all ray trees.
  [[nodiscard]] std::uint64_t segments() const;

  /// Groups, and tunnels once a step has needed them.
  [[nodiscard]] const ImageRegions& regions() const;
  [[nodiscard]] const Residency& residency() const;
  [[nodiscard]] Residency& residency();

  /// From now on colour trees are kept for these sets of parameters alone, and before a step changes them (paper
  /// 4.1.1): an edit within one set runs its residuals; any other colour edit goes through the ray trees. Under
  /// Integrator::path terms of light are kept for all of them together, until an edit of others.
  void choose_parameters(const std::vector<ParameterSet>& sets);

  /// Applies an edit, such as those of an event of a journal. Throws what it throws, with everything as before. Not
  /// during a drag.
  StepResult step(const SceneEdit& edit);
  /// A patch of the look document, with files below `folder`. Throws InputError.
  StepResult step(const Edit& edit, std::string_view file, const std::filesystem::path& folder);

  /// One intermediate frame of a drag (paper 2.2). What the edit moves is taken out of the ray trees when it moves
  /// first, and then only looked for; release() puts it back in where it is. Throws as step() does.
  StepResult drag(const SceneEdit& edit);
  StepResult drag(const Edit& edit, std::string_view file, const std::filesystem::path& folder);
  StepResult release();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relook
