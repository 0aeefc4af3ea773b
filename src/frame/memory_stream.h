// A file in memory as OpenEXR's library reads one. Reading or seeking past the end throws, which OpenEXR passes on.
#pragma once
#include <ImfIO.h>

#include "base/files.h"

namespace relook {

class MemoryStream : public Imf::IStream {
 public:
  /// `bytes` outlive the stream.
  explicit MemoryStream(BytesView bytes) : Imf::IStream("frame"), bytes_(bytes) {}
  bool read(char out[], int count) override;
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override;
  void clear() override {}

 private:
  BytesView bytes_;
  std::uint64_t position_ = 0;  // <= bytes_.size()
};

}  // namespace relook
