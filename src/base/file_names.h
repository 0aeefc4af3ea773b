// What the name of a file says of who has made it: temporary files of write_file() (base/files.h), and files that
// systems leave in any folder.
#pragma once
#include <string_view>

namespace relook {

/// The name that write_file() was writing when it was killed: "NAME" of ".NAME.PID.N.tmp"; "" for other names.
[[nodiscard]] std::string_view name_of_temporary(std::string_view name);

/// Left by a desktop or a file system (.DS_Store, Thumbs.db, .nfs0123...); without a folder.
[[nodiscard]] bool is_system_name(std::string_view name);

}  // namespace relook
