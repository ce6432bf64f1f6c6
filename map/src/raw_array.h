#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>

namespace paloc {

/// Memory for that many bytes, aligned for anything; large blocks on huge pages, where the system
/// has them: a map is hundreds of megabytes, whose small pages take longer to come by than its
/// points take to be put in order. To be given back with freeRaw() and the same size.
void* allocateRaw(std::size_t bytes);
void freeRaw(void* memory, std::size_t bytes);

/// Many objects that are written before they are read.
template <typename T>
class RawArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  RawArray() = default;
  explicit RawArray(std::size_t size)
      : data_(static_cast<T*>(allocateRaw(size * sizeof(T)))), size_(size) {}
  RawArray(RawArray&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  RawArray& operator=(RawArray&& other) noexcept {
    RawArray old(std::move(other));
    std::swap(data_, old.data_);
    std::swap(size_, old.size_);
    return *this;
  }
  RawArray(const RawArray&) = delete;
  RawArray& operator=(const RawArray&) = delete;
  ~RawArray() { freeRaw(data_, size_ * sizeof(T)); }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace paloc
