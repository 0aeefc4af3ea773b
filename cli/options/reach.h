// Which files and folders a command may open, from what its command line and environment name (named_files.h): all that
// the sandbox (base/system/sandbox.h) leaves.
#pragma once
#include "base/system/sandbox.h"
#include "options/arguments.h"

namespace relook {

/// Readable: each input and the folder it lies in (files that it names are there, and so is what another program puts
/// in its place), what links in an input folder lead to, libraries, and what they read of the system; of a `blame`
/// whose run says where its cache or journal is, everything. Writable: folder outputs that are there, the folders of
/// all other outputs, or the nearest ones above them that are there.
[[nodiscard]] Reach reach_of(const Arguments& arguments);

}  // namespace relook
