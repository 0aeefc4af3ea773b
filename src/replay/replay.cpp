#include "replay/replay.h"

#include "base/error.h"
#include "replay/drag.h"
#include "replay/image_pass.h"
#include "replay/path/path_step.h"
#include "replay/recolor.h"
#include "replay/replay_parts.h"

namespace relook {

struct Replayer::Impl {
  ReplayParts parts;
  Recolorer recolorer{parts};
  Drag dragged{parts};

  Impl(SceneState state, Image image, const RegionOptions& options, std::unique_ptr<Residency> pieces,
       std::shared_ptr<StoredTunnels> tunnels)
      : parts(std::move(state), std::move(image), options, std::move(pieces), std::move(tunnels)) {}

  [[nodiscard]] bool has_atoms() const { return parts.stored.regions().options().atoms > 0; }

  void forget_programs(const StepChange& change) {
    if (change.rays.lights_changed) {
      parts.programs.clear();
      parts.color_trees.clear();
      return;
    }
    parts.color_trees.note_colors(change.colors);
    for (const MaterialId material : change.colors.restructured) parts.programs.forget(material);
    if (change.colors.new_environment) parts.programs.forget_environment();
  }

  /// Applies the edit to the scene and finds what it means.
  StepChange begin(const SceneEdit& edit, StepResult& result) {
    parts.residency.begin_change();
    auto [delta, classification] = edit(parts.state);
    const Scene& scene = parts.state.scene();
    result.classification = std::move(classification);
    if (has_atoms()) parts.stored.extend_atoms(parts.atoms());
    // Tunnels hold for the scene in which the trees were made; they are built when a change first needs them.
    StepChange change = find_change(parts.rays, scene, delta, parts.stored.lights());
    if (change.touches_segments() && !change.rays.lights_changed && !parts.stored.regions().has_tunnels())
      parts.stored.build_tunnels(parts.grow());
    parts.rays = ColorScene(parts.rays.after(scene, delta), scene);
    const std::vector<ObjectId> changed = selection_of(change);
    if (parts.level) parts.level->note_changed(changed);
    parts.objects.go_on(parts.rays, changed);
    forget_programs(change);
    result.counters.samples_total = parts.stored.samples();
    return change;
  }

  [[nodiscard]] bool may_compress() const { return parts.color_trees.most_samples() > 0; }

  /// The parameters whose colour trees an edit of colours is to use; null: none.
  [[nodiscard]] const ParameterSet* set_to_keep(const ColorChange& colors) const {
    if (!may_compress() || !is_compressible(colors)) return nullptr;
    return parts.color_trees.set_for(colors.parameters);
  }

  void choose_parameters(const std::vector<ParameterSet>& sets) {
    if (is_path()) {
      ParameterSet all;  // terms are kept for one set
      for (const ParameterSet& set : sets) all.add(set);
      keep_path_terms(parts, all);
      return;
    }
    parts.color_trees.choose(sets);
    for (const ParameterSet& set : sets) {
      if (!may_compress()) return;
      StepChange change = no_change(parts.stored.lights());
      change.colors.parameters = set;
      recolorer.compress(change);
    }
  }

  /// Brings trees, colours and frame up to date with the scene, where `also_shown` was seen on top so far; finish()
  /// follows.
  void update(StepChange& change, StepResult& result, StopWatch& watch,
              const std::vector<SampleColors>& also_shown = {}) {
    if (!change.touches_rays() && also_shown.empty()) {
      if (change.colors.empty()) return;
      if (const ParameterSet* set = set_to_keep(change.colors)) {
        change.colors.parameters = *set;
        recolorer.recolor(change, result, watch);
        return;
      }
    }
    const std::vector<NewSamples> fresh = run_pass(parts, change, {}, result, watch);
    keep_trees(parts, fresh, change);
    watch.lap(change.touches_rays() ? result.seconds.update : result.seconds.evaluate);
    refresh_pixels(parts.stored, fresh, also_shown, {}, result);
    watch.lap(result.seconds.evaluate);
  }

  void finish(StepResult& result) {
    if (has_atoms()) parts.stored.set_atoms(parts.atoms(), parts.grow());
    Counters& counters = result.counters;
    counters.pixels_changed = result.changed_pixels.size();
    const PieceCounts moves = parts.residency.take_counts();
    const auto of = [](const auto& counts, PieceKind kind) { return counts[static_cast<std::size_t>(kind)]; };
    counters.evicted += {of(moves.evicted, PieceKind::ray_trees),  of(moves.evicted, PieceKind::sample_colors),
                         of(moves.evicted, PieceKind::light_sums), moves.others_evicted,
                         of(moves.evicted, PieceKind::tunnels),    moves.evicted_bytes};
    counters.tunnels_read += of(moves.fetched, PieceKind::tunnels);
    counters.reloaded += {of(moves.reloaded, PieceKind::ray_trees),  of(moves.reloaded, PieceKind::sample_colors),
                          of(moves.reloaded, PieceKind::light_sums), 0,
                          of(moves.reloaded, PieceKind::tunnels),    moves.reloaded_bytes};
    counters.rebuilt += parts.stored.take_rebuilt();
    if (counters.ray_tests + counters.ray_tests_culled > 0) return;
    counters.ray_tests_culled = counters.culled.by_class = parts.stored.segments();  // no pass looked at any
  }

  [[nodiscard]] bool is_path() const { return parts.image().view.integrator == Integrator::path; }

  StepResult step(const SceneEdit& edit) {
    if (is_path()) {
      StepResult result = path_step(parts, edit);
      finish(result);
      return result;
    }
    require(!dragged.has_lifted(), "a drag is released before the next step");
    StepResult result;
    StopWatch watch;
    StepChange change = begin(edit, result);
    watch.lap(result.seconds.classify);
    update(change, result, watch);
    finish(result);
    return result;
  }

  /// Under the path integrator a frame of a drag is a step: nothing is lifted out.
  StepResult drag(const SceneEdit& edit) {
    if (is_path()) return step(edit);
    StepResult result;
    StopWatch watch;
    StepChange change = begin(edit, result);
    watch.lap(result.seconds.classify);
    if (Drag::is_movement(change)) {
      dragged.show(change, result, watch);
    } else {  // lights move with the selection, say: not the paper's kind of drag
      const std::vector<SampleColors> shown = dragged.end_with(change);
      update(change, result, watch, shown);
    }
    finish(result);
    return result;
  }

  /// The selection goes into the ray trees; the frame stays as it is.
  StepResult release() {
    StepResult result;
    StopWatch watch;
    result.counters.samples_total = parts.stored.samples();
    StepChange change = no_change(parts.stored.lights());
    if (!is_path()) {
      dragged.end_with(change);
      update(change, result, watch);
    }
    finish(result);
    return result;
  }
};

Replayer::Replayer(SceneState state, Image image, const RegionOptions& options, std::unique_ptr<Residency> residency,
                   std::shared_ptr<StoredTunnels> tunnels)
    : impl_(std::make_unique<Impl>(std::move(state), std::move(image), options, std::move(residency),
                                   std::move(tunnels))) {}
Replayer::~Replayer() = default;
Replayer::Replayer(Replayer&&) noexcept = default;

const SceneState& Replayer::state() const { return impl_->parts.state; }
const std::vector<std::uint32_t>& Replayer::sum_versions() const { return impl_->parts.stored.sum_versions(); }
const Image& Replayer::image() const { return impl_->parts.image(); }
const ImageRegions& Replayer::regions() const { return impl_->parts.stored.regions(); }
const Residency& Replayer::residency() const { return impl_->parts.residency; }
Residency& Replayer::residency() { return impl_->parts.residency; }
std::uint64_t Replayer::segments() const { return impl_->parts.stored.segments(); }

Resident Replayer::resident() const {
  Resident resident = impl_->parts.stored.resident();
  resident.color_trees += impl_->parts.color_trees.bytes();
  resident.total += impl_->parts.color_trees.bytes();
  return resident;
}

void Replayer::choose_parameters(const std::vector<ParameterSet>& sets) { impl_->choose_parameters(sets); }
StepResult Replayer::step(const SceneEdit& edit) { return impl_->step(edit); }
StepResult Replayer::step(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
  return step(scene_edit(edit, file, folder));
}
StepResult Replayer::drag(const SceneEdit& edit) { return impl_->drag(edit); }
StepResult Replayer::drag(const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
  return drag(scene_edit(edit, file, folder));
}
StepResult Replayer::release() { return impl_->release(); }

}  // namespace relook
