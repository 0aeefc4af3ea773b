// A contact sheet: pictures side by side with labels, drawn into one image. Pictures are linear: as frames have them,
// or as a display shows them (as_displayed()), and the sheet is what they are. Labels are white in both.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "frame/preview.h"

namespace relook {

struct SheetPicture {
  Frame frame;                      // of the size that it is to have in the sheet; without pixels: an empty place
  std::string name;                 // below it, in two lines at the most
  std::vector<std::string> values;  // a line each, below the name
};

/// What varies along a side of a grid.
struct SheetAxis {
  std::string label;
  std::vector<std::string> texts;  // one a row, or one a column
};

/// Pictures under a heading of their own.
struct SheetGroup {
  std::string heading;             // "": none
  std::vector<std::string> notes;  // below the heading, in lines that are broken
  std::vector<SheetPicture> pictures;
  /// Of a grid: its pictures are row by row, rows.texts.size() * columns.texts.size() of them.
  struct Grid {
    SheetAxis rows, columns;
  };
  std::optional<Grid> grid;
};

struct ContactSheet {
  std::string title;               // "": none
  std::vector<std::string> notes;  // below the title
  std::vector<SheetGroup> groups;
  std::uint32_t columns = 0;  // pictures in a row, of groups that are no grids; 0: as suits a sheet about 16:10
};

/// The sheet, opaque. Throws UsageError when it would be larger than images that are read (frame/exr_file.h), Error as
/// drawn_text().
[[nodiscard]] Frame draw_contact_sheet(const ContactSheet& sheet);

/// A frame `width` pixels wide, with its proportions, each pixel the mean of those that it covers, parts of pixels
/// included (a box filter); of frames that are no wider, a copy. Numbers that are not finite count as 0.
[[nodiscard]] Frame scaled_down(const Frame& frame, std::uint32_t width);

/// The light that a display emits for a frame's preview, 0..1, to 8-bit codes. Previews and as_displayed() agree:
/// encode_displayed(as_displayed(frame, style), style) has the pixels of encode_png(frame, style).
[[nodiscard]] Frame as_displayed(const Frame& frame, const PreviewStyle& style);
/// A PNG file of such light, for the display of `style`.
[[nodiscard]] Bytes encode_displayed(const Frame& light, const PreviewStyle& style);

}  // namespace relook
