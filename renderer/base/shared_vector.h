#pragma once
// A copy-on-write vector for large data that is rarely edited. Const access never copies; non-const access
// first makes the elements unique.
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace lucerna {

/// Distinct objects may be used from several threads, even if they share elements.
template <class T>
class SharedVector {
 public:
  using value_type = T;
  SharedVector() = default;
  SharedVector(std::initializer_list<T> items) : SharedVector(std::vector<T>(items)) {}
  SharedVector(std::vector<T> items) : items_(std::make_shared<std::vector<T>>(std::move(items))) {}

  size_t size() const { return read().size(); }
  bool empty() const { return read().empty(); }
  auto begin() const { return read().begin(); }
  auto end() const { return read().end(); }
  const T& operator[](size_t i) const { return read()[i]; }
  const T& at(size_t i) const { return read().at(i); }
  const T& front() const { return read().front(); }
  const T& back() const { return read().back(); }
  operator const std::vector<T>&() const { return read(); }
  /// True if both share the same elements.
  bool shares_with(const SharedVector& other) const { return items_ == other.items_; }

  auto begin() { return own().begin(); }
  auto end() { return own().end(); }
  T& operator[](size_t i) { return own()[i]; }
  T& at(size_t i) { return own().at(i); }
  T& front() { return own().front(); }
  T& back() { return own().back(); }
  void push_back(T item) { own().push_back(std::move(item)); }
  template <class... Args>
  T& emplace_back(Args&&... args) {
    return own().emplace_back(std::forward<Args>(args)...);
  }
  template <class Predicate>
  void erase_if(Predicate unwanted) {
    std::erase_if(own(), std::move(unwanted));
  }
  void pop_back() { own().pop_back(); }
  void resize(size_t count) { own().resize(count); }
  void reserve(size_t count) { own().reserve(count); }
  void clear() { items_.reset(); }

 private:
  const std::vector<T>& read() const {
    static const std::vector<T> none;
    return items_ ? *items_ : none;
  }
  std::vector<T>& own() {
    if (!items_)
      items_ = std::make_shared<std::vector<T>>();
    else if (items_.use_count() > 1)
      items_ = std::make_shared<std::vector<T>>(*items_);
    return *items_;
  }

  std::shared_ptr<std::vector<T>> items_;  ///< null: empty
};

}  // namespace lucerna
