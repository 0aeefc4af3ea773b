#include "frame/sheet/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "frame/exr_file.h"
#include "frame/sheet/text_drawing.h"

namespace relook {
namespace {

constexpr float kWhite = 1, kGray = 0.45F, kBackground = 0.012F, kEmptyPlace = 0.03F;  // linear

/// A line of text with the place of its upper left corner.
struct PlacedText {
  TextMask mask;
  std::uint32_t x = 0, y = 0;
  float light = kWhite;
};
struct PlacedPicture {
  const Frame* frame = nullptr;
  std::uint32_t x = 0, y = 0;
};
/// An empty place of a grid.
struct PlacedBox {
  std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// Lines that belong together, one below the other.
struct TextBlock {
  std::vector<TextMask> lines;
  std::vector<float> lights;  // of the lines

  void add(std::vector<TextMask> more, float light) {
    lights.resize(lights.size() + more.size(), light);
    std::move(more.begin(), more.end(), std::back_inserter(lines));
  }
  [[nodiscard]] std::uint32_t height() const {
    std::uint32_t height = 0;
    for (const TextMask& line : lines) height += line.height;
    return height;
  }
  [[nodiscard]] std::uint32_t width() const {
    std::uint32_t width = 0;
    for (const TextMask& line : lines) width = std::max(width, line.width);
    return width;
  }
};

/// Sizes of a sheet that follow from those of its pictures.
struct Measures {
  std::uint32_t cell_width = 0, cell_height = 0;  // of a picture, the largest
  double text = 0;                                // pixels: of the text below pictures
  std::uint32_t gap = 0;                          // between pictures; also the margin
  std::uint32_t columns = 1;
};

enum class Align : std::uint8_t { left, center, right };

/// Places everything from top to bottom, then draws it.
class SheetLayout {
 public:
  SheetLayout(const Measures& measures) : measures_(measures), y_(measures.gap), width_(0) {}

  /// Lines over the width of the sheet's columns.
  void add_heading(const std::string& heading, double scale, const std::vector<std::string>& notes);
  void add_flow(const std::vector<SheetPicture>& pictures);
  void add_grid(const std::vector<SheetPicture>& pictures, const SheetGroup::Grid& grid);
  void add_space() { y_ += measures_.gap; }
  [[nodiscard]] Frame drawn() const;

 private:
  void place(TextBlock block, std::uint32_t x, std::uint32_t y, std::uint32_t width, Align align);
  /// A picture with its labels; the height of both.
  std::uint32_t place(const SheetPicture& picture, std::uint32_t x, std::uint32_t y);
  [[nodiscard]] TextBlock labels_of(const SheetPicture& picture) const;
  [[nodiscard]] std::uint32_t column_x(std::size_t column) const {
    return measures_.gap + static_cast<std::uint32_t>(column) * (measures_.cell_width + measures_.gap);
  }

  Measures measures_;
  std::uint32_t y_, width_;  // below, and to the right of all that is placed
  std::vector<PlacedText> texts_;
  std::vector<PlacedPicture> pictures_;
  std::vector<PlacedBox> boxes_;
};

void SheetLayout::place(TextBlock block, std::uint32_t x, std::uint32_t y, std::uint32_t width, Align align) {
  for (std::size_t i = 0; i < block.lines.size(); ++i) {
    TextMask& line = block.lines[i];
    const std::uint32_t room = width - std::min(width, line.width);
    const std::uint32_t shift = align == Align::left ? 0 : align == Align::center ? room / 2 : room;
    width_ = std::max(width_, x + shift + line.width);
    const std::uint32_t height = line.height;
    texts_.push_back({std::move(line), x + shift, y, block.lights[i]});
    y += height;
  }
}

TextBlock SheetLayout::labels_of(const SheetPicture& picture) const {
  constexpr std::size_t kNameLines = 2, kValueLines = 2;
  TextBlock block;
  block.add(drawn_lines(picture.name, measures_.text, measures_.cell_width, kNameLines), kWhite);
  for (const std::string& value : picture.values)
    block.add(drawn_lines(value, measures_.text, measures_.cell_width, kValueLines), kGray);
  return block;
}

std::uint32_t SheetLayout::place(const SheetPicture& picture, std::uint32_t x, std::uint32_t y) {
  std::uint32_t height = picture.frame.height;
  if (picture.frame.pixels.empty()) {
    height = measures_.cell_height;
    boxes_.push_back({x, y, measures_.cell_width, height});
  } else {
    pictures_.push_back({&picture.frame, x, y});
  }
  width_ = std::max(width_, x + measures_.cell_width);
  const std::uint32_t space = measures_.gap / 4;
  TextBlock labels = labels_of(picture);
  const std::uint32_t all = height + space + labels.height();
  place(std::move(labels), x, y + height + space, measures_.cell_width, Align::left);
  return all;
}

void SheetLayout::add_heading(const std::string& heading, double scale, const std::vector<std::string>& notes) {
  constexpr std::size_t kHeadingLines = 3, kNoteLines = 6;
  constexpr double kLeastWidth = 36;  // of the text's height
  const std::uint32_t width = std::max(column_x(measures_.columns) - 2 * measures_.gap,
                                       static_cast<std::uint32_t>(measures_.text * kLeastWidth));
  TextBlock block;
  if (!heading.empty()) block.add(drawn_lines(heading, measures_.text * scale, width, kHeadingLines), kWhite);
  for (const std::string& note : notes) block.add(drawn_lines(note, measures_.text, width, kNoteLines), kGray);
  if (block.lines.empty()) return;
  const std::uint32_t height = block.height();
  place(std::move(block), measures_.gap, y_, width, Align::left);
  y_ += height + measures_.gap / 2;
}

void SheetLayout::add_flow(const std::vector<SheetPicture>& pictures) {
  for (std::size_t first = 0; first < pictures.size(); first += measures_.columns) {
    std::uint32_t height = 0;
    for (std::size_t i = first; i < std::min<std::size_t>(first + measures_.columns, pictures.size()); ++i)
      height = std::max(height, place(pictures[i], column_x(i - first), y_));
    y_ += height + measures_.gap;
  }
}

/// Above the pictures the columns' values and what they are of, to the left of them the rows'.
void SheetLayout::add_grid(const std::vector<SheetPicture>& pictures, const SheetGroup::Grid& grid) {
  constexpr std::size_t kTextLines = 3;
  const std::uint32_t side = std::max(measures_.cell_width / 2, static_cast<std::uint32_t>(measures_.text * 6));
  std::vector<TextBlock> rows(grid.rows.texts.size());
  for (std::size_t row = 0; row < rows.size(); ++row)
    rows[row].add(drawn_lines(grid.rows.texts[row], measures_.text, side, kTextLines), kWhite);
  TextBlock corner;
  corner.add(drawn_lines(grid.rows.label, measures_.text, side, kTextLines), kGray);
  std::uint32_t side_width = corner.width();
  for (const TextBlock& row : rows) side_width = std::max(side_width, row.width());
  const std::uint32_t left = side_width + measures_.gap;

  TextBlock name;
  name.add(drawn_lines(grid.columns.label, measures_.text, column_x(grid.columns.texts.size()) - measures_.gap, 1),
           kGray);
  const std::uint32_t name_height = name.height();
  place(std::move(name), left + measures_.gap, y_, 0, Align::left);
  y_ += name_height;
  std::vector<TextBlock> heads(grid.columns.texts.size());
  std::uint32_t head_height = corner.height();
  for (std::size_t column = 0; column < heads.size(); ++column) {
    heads[column].add(drawn_lines(grid.columns.texts[column], measures_.text, measures_.cell_width, kTextLines),
                      kWhite);
    head_height = std::max(head_height, heads[column].height());
  }
  const auto place_low = [&](TextBlock block, std::uint32_t x, std::uint32_t width, Align align) {
    const std::uint32_t height = block.height();
    place(std::move(block), x, y_ + head_height - height, width, align);
  };
  place_low(std::move(corner), measures_.gap, side_width, Align::right);
  for (std::size_t column = 0; column < heads.size(); ++column)
    place_low(std::move(heads[column]), left + column_x(column), measures_.cell_width, Align::center);
  y_ += head_height + measures_.gap / 4;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    std::uint32_t height = 0;
    for (std::size_t column = 0; column < heads.size(); ++column)
      height = std::max(height, place(pictures[row * heads.size() + column], left + column_x(column), y_));
    const std::uint32_t text_height = rows[row].height();
    const std::uint32_t middle = (measures_.cell_height - std::min(measures_.cell_height, text_height)) / 2;
    place(std::move(rows[row]), measures_.gap, y_ + middle, side_width, Align::right);
    y_ += std::max(height, text_height) + measures_.gap / 2;
  }
  y_ += measures_.gap / 2;
}

void draw(const PlacedText& text, Frame& sheet) {
  constexpr float kCovered = 255;
  for (std::uint32_t y = 0; y < text.mask.height; ++y)
    for (std::uint32_t x = 0; x < text.mask.width; ++x) {
      Rgba& pixel = sheet.pixels[std::size_t{text.y + y} * sheet.width + text.x + x];
      const float share = static_cast<float>(text.mask.coverage[std::size_t{y} * text.mask.width + x]) / kCovered;
      for (int channel = 0; channel < 3; ++channel) pixel[channel] += (text.light - pixel[channel]) * share;
    }
}

/// A frame's colours count as they are over black: what is not covered stays black, and the sheet is opaque.
void draw(const PlacedPicture& picture, Frame& sheet) {
  const Frame& frame = *picture.frame;
  for (std::uint32_t y = 0; y < frame.height; ++y)
    for (std::uint32_t x = 0; x < frame.width; ++x) {
      const Rgba& pixel = frame.pixels[std::size_t{y} * frame.width + x];
      sheet.pixels[std::size_t{picture.y + y} * sheet.width + picture.x + x] = {pixel.r, pixel.g, pixel.b, 1};
    }
}

void draw(const PlacedBox& box, Frame& sheet) {
  for (std::uint32_t y = 0; y < box.height; ++y)
    std::fill_n(&sheet.pixels[std::size_t{box.y + y} * sheet.width + box.x], box.width,
                Rgba(kEmptyPlace, kEmptyPlace, kEmptyPlace, 1));
}

Frame SheetLayout::drawn() const {
  Frame sheet{width_ + measures_.gap, y_, {}};
  if (!is_read_size(sheet.width, sheet.height))
    throw UsageError("a sheet of " + std::to_string(sheet.width) + "x" + std::to_string(sheet.height) +
                     " pixels is too large: fewer or narrower pictures are needed");
  sheet.pixels.assign(std::size_t{sheet.width} * sheet.height, Rgba(kBackground, kBackground, kBackground, 1));
  for (const PlacedBox& box : boxes_) draw(box, sheet);
  for (const PlacedPicture& picture : pictures_) draw(picture, sheet);
  for (const PlacedText& text : texts_) draw(text, sheet);
  return sheet;
}

/// The number of pictures in a row that makes the sheet about 16:10, and no narrower than its grids.
std::uint32_t usual_columns(const ContactSheet& sheet, const Measures& measures) {
  constexpr double kShape = 1.6, kLabels = 3.5;
  std::size_t most = 1, least = 1, all = 0;
  for (const SheetGroup& group : sheet.groups) {
    all += group.pictures.size();
    if (group.grid) least = std::max(least, group.grid->columns.texts.size());
    if (!group.grid) most = std::max(most, group.pictures.size());
  }
  const double height = measures.cell_height + kLabels * measures.text;
  const double columns = std::sqrt(static_cast<double>(all) * kShape * height / std::max(measures.cell_width, 1U));
  const auto widest = static_cast<double>(std::max(least, most));
  return static_cast<std::uint32_t>(std::clamp(std::round(columns), static_cast<double>(least), widest));
}

Measures measures_of(const ContactSheet& sheet) {
  constexpr double kTextShare = 0.045, kLeastText = 11, kMostText = 28;
  constexpr std::uint32_t kLeastWidth = 64;  // for labels
  Measures measures;
  for (const SheetGroup& group : sheet.groups)
    for (const SheetPicture& picture : group.pictures) {
      measures.cell_width = std::max(measures.cell_width, picture.frame.width);
      measures.cell_height = std::max(measures.cell_height, picture.frame.height);
    }
  measures.cell_width = std::max(measures.cell_width, kLeastWidth);
  measures.text = std::clamp(std::round(measures.cell_width * kTextShare), kLeastText, kMostText);
  measures.gap = static_cast<std::uint32_t>(measures.text);
  measures.columns = sheet.columns > 0 ? sheet.columns : usual_columns(sheet, measures);
  return measures;
}

}  // namespace

Frame draw_contact_sheet(const ContactSheet& sheet) {
  constexpr double kTitle = 1.5, kHeading = 1.15;
  SheetLayout layout(measures_of(sheet));
  layout.add_heading(sheet.title, kTitle, sheet.notes);
  for (const SheetGroup& group : sheet.groups) {
    if (!group.heading.empty() || !group.notes.empty()) layout.add_space();
    layout.add_heading(group.heading, kHeading, group.notes);
    if (!group.grid) {
      layout.add_flow(group.pictures);
      continue;
    }
    require(group.pictures.size() == group.grid->rows.texts.size() * group.grid->columns.texts.size(),
            "a grid has a picture, or an empty place, for each pair of values");
    layout.add_grid(group.pictures, *group.grid);
  }
  return layout.drawn();
}

}  // namespace relook
