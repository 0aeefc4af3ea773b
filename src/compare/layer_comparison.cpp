#include "compare/layer_comparison.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "compare/row_comparison.h"

namespace relook {
namespace {

constexpr const char* kPictureLayer = "RGBA";

struct ChannelPair {
  std::string name;
  std::optional<std::size_t> a, b;  // places in the images' channels
  bool is_id = false, is_other_kind = false;
  ChannelTotals totals;
  [[nodiscard]] bool is_compared() const { return a && b && !is_other_kind; }
};

/// A layer while its rows are compared.
struct OpenLayer {
  LayerDifference difference;
  std::vector<ChannelPair> channels;
  LayerRow row;
};

bool is_cryptomatte_rank(const std::string& layer, std::span<const std::string> cryptomattes) {
  return std::ranges::any_of(cryptomattes, [&](const std::string& name) {
    return layer.starts_with(name) && layer.size() >= name.size() + 2 &&
           layer.find_first_not_of("0123456789", name.size()) == std::string::npos;
  });
}

std::vector<OpenLayer> open_layers(const ExrImage& a, const ExrImage& b,
                                   std::span<const std::string> cryptomattes) {
  std::map<std::string, ChannelPair> pairs;
  for (std::size_t i = 0; i < a.channels.size(); ++i) pairs[a.channels[i].name].a = i;
  for (std::size_t i = 0; i < b.channels.size(); ++i) pairs[b.channels[i].name].b = i;
  std::vector<OpenLayer> layers;
  for (auto& [name, pair] : pairs) {
    const std::string layer = layer_name(name);
    auto found = std::ranges::find(layers, layer, [](const OpenLayer& open) { return open.difference.layer; });
    if (found == layers.end()) {
      found = layers.emplace(layer == kPictureLayer ? layers.begin() : layers.end());
      found->difference.layer = layer;
    }
    const bool is_uint_a = pair.a && a.channels[*pair.a].kind == SampleKind::uint32;
    const bool is_uint_b = pair.b && b.channels[*pair.b].kind == SampleKind::uint32;
    pair.name = name;
    pair.is_id = is_uint_a || is_uint_b || is_cryptomatte_rank(layer, cryptomattes);
    pair.is_other_kind = pair.a && pair.b && is_uint_a != is_uint_b;
    if (!pair.b) found->difference.only_a.push_back(name);
    if (!pair.a) found->difference.only_b.push_back(name);
    if (pair.is_other_kind) found->difference.other_kinds.push_back(name);
    found->channels.push_back(pair);
  }
  return layers;
}

SampleRow sample_row(const ImageRows& rows, std::size_t channel, std::int64_t y) {
  SampleRow row{.kind = rows.image().channels[channel].kind};
  if (!rows.holds(y)) return row;
  row.samples = rows.row(channel, y);
  row.x0 = rows.image().window.x0, row.x1 = rows.image().window.x1;
  return row;
}

/// Both images' bands, decoded at the same time.
void load_row(ImageRows& a, ImageRows& b, std::int64_t y) {
  std::vector<ImageRows*> waiting;
  for (ImageRows* rows : {&a, &b}) {
    const PixelWindow& window = rows->image().window;
    if (y >= window.y0 && y < window.y1 && !rows->holds(y)) waiting.push_back(rows);
  }
  parallel_for(waiting.size(), [&](std::size_t i) { waiting[i]->load(y); });
}

void count_row(OpenLayer& layer, const Thresholds& thresholds) {
  if (!layer.row.has_difference) return;
  LayerDifference& difference = layer.difference;
  for (std::size_t i = 0; i < layer.row.errors.size(); ++i) {
    const double error = layer.row.errors[i];
    if (error == LayerRow::kSame) continue;
    ++difference.figures.pixels_different;
    difference.figures.pixels_above_fail += thresholds.counts_as_failure(error) ? 1 : 0;
    difference.figures.pixels_above_warn += thresholds.counts_as_warning(error) ? 1 : 0;
    difference.pixels_other_ids += layer.row.other_ids[i] != 0 ? 1 : 0;
  }
}

void keep_row(const ImageRows& rows, std::int64_t y, const PixelWindow& window, Frame& frame) {
  const auto row = static_cast<std::size_t>((y - window.y0) * window.width());
  const auto keep = [&](const char* name, float Rgba::*member) {
    const std::vector<StoredChannel>& channels = rows.image().channels;
    const auto found = std::ranges::find(channels, name, &StoredChannel::name);
    SampleRow samples{.x0 = rows.image().window.x0, .x1 = rows.image().window.x1};
    if (found != channels.end()) samples = sample_row(rows, static_cast<std::size_t>(found - channels.begin()), y);
    for (std::int64_t x = samples.x0; x < samples.x1; ++x)
      frame.pixels[row + static_cast<std::size_t>(x - window.x0)].*member =
          found == channels.end() ? 1.0F : samples.quantity(x);
  };
  keep("R", &Rgba::r);
  keep("G", &Rgba::g);
  keep("B", &Rgba::b);
  keep("A", &Rgba::a);
}

void set_verdict(LayerDifference& difference, const Thresholds& thresholds) {
  if (difference.has_other_channels()) difference.figures.pixels_different = difference.figures.pixels_compared;
  const bool never_passes = difference.has_other_channels() || difference.pixels_other_ids > 0;
  difference.verdict = never_passes ? Verdict::failure : verdict_of(difference.figures, thresholds);
}

LayerDifference closed(OpenLayer& layer, const PixelWindow& window, const Thresholds& thresholds) {
  LayerDifference& difference = layer.difference;
  difference.figures.pixels_compared = static_cast<std::uint64_t>(window.width() * window.height());
  double squares = 0, quantities = 0;
  for (const ChannelPair& channel : layer.channels) {
    if (difference.first_channel.empty() && (channel.totals.has_difference || !channel.is_compared()))
      difference.first_channel = channel.name;
    if (channel.is_id || !channel.is_compared()) continue;
    difference.has_quantities = true;
    quantities += 1;
    squares += channel.totals.squares;
    difference.figures.max_error = std::max(difference.figures.max_error, channel.totals.max_error);
  }
  if (quantities > 0)
    difference.rms_error = std::sqrt(squares / (quantities * static_cast<double>(difference.figures.pixels_compared)));
  set_verdict(difference, thresholds);
  return std::move(difference);
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json printable_names(const std::vector<std::string>& names) {
  Json list = Json::array();
  for (const std::string& name : names) list.push_back(printable(name));
  return list;
}

}  // namespace

std::string layer_name(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  if (dot != std::string::npos) return channel.substr(0, dot);
  return channel == "R" || channel == "G" || channel == "B" || channel == "A" ? kPictureLayer : channel;
}

std::vector<LayerDifference> compare_layers(ImageRows& a, ImageRows& b, const PixelWindow& window,
                                            const LayerRules& rules, KeptPictures* pictures) {
  std::vector<OpenLayer> layers = open_layers(a.image(), b.image(), rules.cryptomattes);
  for (std::int64_t y = window.y0; y < window.y1; ++y) {
    load_row(a, b, y);
    for (OpenLayer& layer : layers) {
      layer.row.reset(static_cast<std::size_t>(window.width()));
      for (ChannelPair& channel : layer.channels)
        if (channel.is_compared())
          compare_rows(sample_row(a, *channel.a, y), sample_row(b, *channel.b, y), window.x0, channel.is_id, layer.row,
                       channel.totals);
      count_row(layer, rules.thresholds);
    }
    if (pictures != nullptr && a.holds(y)) keep_row(a, y, window, pictures->a);
    if (pictures != nullptr && b.holds(y)) keep_row(b, y, window, pictures->b);
  }
  std::vector<LayerDifference> differences;
  for (OpenLayer& layer : layers) differences.push_back(closed(layer, window, rules.thresholds));
  return differences;
}

std::vector<LayerDifference> lacking_layers(const ExrImage& image, bool is_a) {
  ExrImage nothing = image;
  nothing.channels.clear();
  std::vector<LayerDifference> differences;
  for (OpenLayer& layer : is_a ? open_layers(image, nothing, {}) : open_layers(nothing, image, {}))
    differences.push_back(closed(layer, image.window, {}));
  return differences;
}

std::string layer_place(const LayerDifference& difference) {
  std::string place;
  if (!difference.part.empty()) place += "part " + difference.part + ", ";
  if (!difference.level.empty()) place += "level " + difference.level + ", ";
  return place + "layer " + difference.layer;
}

std::string first_difference(const LayerDifference& difference) {
  if (difference.first_channel.empty()) return "";
  std::string place;
  if (!difference.part.empty()) place += "part " + difference.part + ", ";
  if (!difference.level.empty()) place += "level " + difference.level + ", ";
  place += "channel " + difference.first_channel;
  const auto is_in = [&](const std::vector<std::string>& names) {
    return std::ranges::find(names, difference.first_channel) != names.end();
  };
  if (is_in(difference.only_a)) return place + ", only in the first";
  if (is_in(difference.only_b)) return place + ", only in the second";
  return is_in(difference.other_kinds) ? place + ", uint in one only" : place;
}

Json layer_json(const LayerDifference& difference) {
  const ErrorFigures& figures = difference.figures;
  const auto error = [&](double value) { return difference.has_quantities ? finite_or_null(value) : Json(nullptr); };
  Json json{{"part", printable(difference.part)},           {"level", difference.level},
            {"layer", printable(difference.layer)},         {"pixels_compared", figures.pixels_compared},
            {"pixels_different", figures.pixels_different}, {"max_error", error(figures.max_error)},
            {"rms_error", error(difference.rms_error)},     {"verdict", verdict_name(difference.verdict)}};
  if (difference.verdict == Verdict::equal) return json;
  json["pixels_other_ids"] = difference.pixels_other_ids;
  json["pixels_above_fail"] = figures.pixels_above_fail;
  json["pixels_above_warn"] = figures.pixels_above_warn;
  json["first_channel"] = printable(difference.first_channel);
  json["only_in_a"] = printable_names(difference.only_a);
  json["only_in_b"] = printable_names(difference.only_b);
  json["other_kinds"] = printable_names(difference.other_kinds);
  return json;
}

}  // namespace relook
