#include "frame/memory_stream.h"

#include <cstring>
#include <stdexcept>

namespace relook {

bool MemoryStream::read(char out[], int count) {
  if (count < 0 || static_cast<std::uint64_t>(count) > bytes_.size() - position_)
    throw std::runtime_error("the file is cut short");
  std::memcpy(out, bytes_.data() + position_, static_cast<std::size_t>(count));
  position_ += static_cast<std::uint64_t>(count);
  return position_ < bytes_.size();
}

void MemoryStream::seekg(std::uint64_t position) {
  if (position > bytes_.size()) throw std::runtime_error("the file is cut short");
  position_ = position;
}

}  // namespace relook
