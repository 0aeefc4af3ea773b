// The header of an OpenEXR file, checked before the library sees it: OpenEXR 3.1 takes memory for the size that an
// attribute says, 2 GB of a file of some hundred bytes.
#pragma once
#include <string>

#include "base/files.h"

namespace relook {

/// What is wrong with the headers of a file that begins with OpenEXR's magic number; "" when every attribute, and every
/// value in it that has a size of its own, lies within the file and takes the bytes that it says.
[[nodiscard]] std::string exr_header_fault(BytesView exr);

}  // namespace relook
