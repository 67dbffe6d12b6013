#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <ImathVec.h>

namespace abbe {

/// Points to be found by place, by their numbers: a k-d tree [Bentley1975] of where photons have come to
/// [Jensen1996]. What is found, and in which order, depends on the points alone. Any threads may ask at once.
class PhotonMap {
 public:
  /// What a point takes in memory [bytes].
  static constexpr std::size_t kBytesOfPoint = sizeof(Imath::V3f) + 2 * sizeof(std::uint32_t);

  explicit PhotonMap(std::vector<Imath::V3f> points);
  ~PhotonMap();
  PhotonMap(PhotonMap&&) noexcept;
  PhotonMap& operator=(PhotonMap&&) noexcept;

  [[nodiscard]] std::size_t size() const;

  /// Sets `found` to those whose distance from a point is less than `radius`, in the order of their numbers.
  void within(const Imath::V3f& point, float radius, std::vector<std::uint32_t>& found) const;
  /// Sets `found` to the `count` nearest to a point, fewer only where there are no more, from the nearest on.
  void nearest(const Imath::V3f& point, std::size_t count, std::vector<std::uint32_t>& found) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace abbe
