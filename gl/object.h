// A GL object's name that deletes itself: move-only, 0 when empty.
#pragma once

#include <utility>

namespace sfumato::gl {

template <void (*destroy)(unsigned)>
class Object {
 public:
  Object() = default;
  explicit Object(unsigned name) : name_(name) {}
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Object() {
    if (name_ != 0) destroy(name_);
  }
  unsigned name() const { return name_; }

 private:
  unsigned name_ = 0;
};

}  // namespace sfumato::gl
