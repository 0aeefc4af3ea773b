// The fuzz targets: each takes any bytes and returns 0, or ends the process when what they lead to is neither a result
// nor an error with an exit code that stands for them. Built twice: a libFuzzer program each (tests/fuzz.sh), and into
// relook_tests, which replays the kept corpus.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace relook {

int fuzz_scene(const std::uint8_t* data, std::size_t size);    // bytes of a .glb or .gltf
int fuzz_packed(const std::uint8_t* data, std::size_t size);   // a compressed mesh, and what is said of it
int fuzz_patch(const std::uint8_t* data, std::size_t size);    // text of --look
int fuzz_journal(const std::uint8_t* data, std::size_t size);  // text of a journal
int fuzz_cache(const std::uint8_t* data, std::size_t size);    // changes to a cache, whose hashes are mended then
int fuzz_image(const std::uint8_t* data, std::size_t size);    // bytes of an image
int fuzz_notes(const std::uint8_t* data, std::size_t size);    // text of an access log, report or progress file
int fuzz_replay(const std::uint8_t* data, std::size_t size);   // choices of a scene and edits

/// Mutates `size` bytes at `data`, of which there may be `most`; returns the new size.
using Mutate = std::size_t(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);

std::size_t mutate_scene(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);
std::size_t mutate_json_text(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);
std::size_t mutate_image(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);

struct FuzzTarget {
  const char* name;
  int (*run)(const std::uint8_t* data, std::size_t size);
  Mutate* mutate = nullptr;  // null: bytes alone
};
inline constexpr std::array<FuzzTarget, 8> kFuzzTargets{{{"scene", fuzz_scene, mutate_scene},
                                                         {"packed", fuzz_packed},
                                                         {"patch", fuzz_patch, mutate_json_text},
                                                         {"journal", fuzz_journal, mutate_json_text},
                                                         {"cache", fuzz_cache},
                                                         {"image", fuzz_image, mutate_image},
                                                         {"notes", fuzz_notes},
                                                         {"replay", fuzz_replay}}};

}  // namespace relook
