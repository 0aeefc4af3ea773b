// Tables whose copies share their entries: a copy costs a pointer an entry and a reference count a block of entries, an
// entry that is replaced in it costs its block. Entries never change and stay where they are while any table has them.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace relook {

template <class T>
class SharedTable {
 public:
  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] const T& operator[](std::size_t i) const { return *entries_[i]; }
  /// By index, to be read without this table's own indirection. Valid until the table changes.
  [[nodiscard]] const T* const* entries() const { return entries_.data(); }
  /// An entry that outlives the table.
  [[nodiscard]] const std::shared_ptr<const T>& share(std::size_t i) const {
    return (*blocks_[i / kBlock])[i % kBlock];
  }

  void push_back(std::shared_ptr<const T> entry) {
    if (entries_.size() % kBlock == 0) blocks_.push_back(std::make_shared<Block>());
    entries_.push_back(entry.get());
    own_block(entries_.size() - 1)[(entries_.size() - 1) % kBlock] = std::move(entry);
  }
  void replace(std::size_t i, std::shared_ptr<const T> entry) {
    std::shared_ptr<const T>& place = own_block(i)[i % kBlock];
    entries_[i] = entry.get();
    place = std::move(entry);
  }

 private:
  static constexpr std::size_t kBlock = 256;
  using Block = std::array<std::shared_ptr<const T>, kBlock>;

  /// The block of an entry, which no other table has.
  Block& own_block(std::size_t i) {
    std::shared_ptr<Block>& block = blocks_[i / kBlock];
    if (block.use_count() > 1) block = std::make_shared<Block>(*block);
    return *block;
  }

  std::vector<const T*> entries_;
  std::vector<std::shared_ptr<Block>> blocks_;  // own the entries
};

}  // namespace relook
