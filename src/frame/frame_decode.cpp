// Reads R, G, B and perhaps A of the first part of any flat OpenEXR image. The header is checked before pixels are
// allocated; everything OpenEXR throws becomes one InputError.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <string>

#include "base/error.h"
#include "frame/exr_file.h"
#include "frame/frame_file.h"
#include "frame/memory_stream.h"

namespace relook {
namespace {

Imath::Box2i checked_window(const Imf::InputFile& input, std::string_view file) {
  const Imath::Box2i window = input.header().dataWindow();
  if (!is_read_size(std::int64_t{window.max.x} - window.min.x + 1, std::int64_t{window.max.y} - window.min.y + 1))
    throw InputError(file, "dataWindow", "an image this large is not read");
  for (const char* name : {"R", "G", "B"}) {
    const Imf::Channel* channel = input.header().channels().findChannel(name);
    if (channel == nullptr) throw InputError(file, "channels", std::string("no channel ") + name);
    if (channel->xSampling != 1 || channel->ySampling != 1)
      throw InputError(file, "channels", std::string("channel ") + name + " is subsampled");
  }
  return window;
}

}  // namespace

Frame decode_exr(BytesView bytes, std::string_view file) {
  try {
    MemoryStream stream(bytes);
    Imf::InputFile input(stream, 0);
    const Imath::Box2i window = checked_window(input, file);
    Frame frame;
    frame.width = static_cast<std::uint32_t>(window.max.x - window.min.x + 1);
    frame.height = static_cast<std::uint32_t>(window.max.y - window.min.y + 1);
    frame.pixels.resize(std::size_t{frame.width} * frame.height);
    Imf::FrameBuffer target;
    float* first = &frame.pixels[0].r;
    const char* names[] = {"R", "G", "B", "A"};
    for (int channel = 0; channel < 4; ++channel)
      target.insert(names[channel], Imf::Slice::Make(Imf::FLOAT, first + channel, window, sizeof(Rgba),
                                                     sizeof(Rgba) * frame.width, 1, 1, channel == 3 ? 1.0 : 0.0));
    input.setFrameBuffer(target);
    input.readPixels(window.min.y, window.max.y);
    return frame;
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(file, "", std::string("not a readable OpenEXR image: ") + error.what());
  }
}

Frame decode_exr(const std::filesystem::path& path) {
  const Bytes bytes = read_file(path);
  return decode_exr(bytes, path.string());
}

}  // namespace relook
