#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <ImathVec.h>

namespace abbe {

/// K-d tree [Bentley1975] of photon positions [m], queried by position [Jensen1996]. Points are numbered from
/// 0 in the order in which the constructor receives them. Results and their order depend on the points alone.
/// Queries may run concurrently.
class PhotonMap {
 public:
  /// Memory per point [bytes].
  static constexpr std::size_t kBytesOfPoint = sizeof(Imath::V3f) + 2 * sizeof(std::uint32_t);

  explicit PhotonMap(std::vector<Imath::V3f> points);
  ~PhotonMap();
  PhotonMap(PhotonMap&&) noexcept;
  PhotonMap& operator=(PhotonMap&&) noexcept;

  [[nodiscard]] std::size_t size() const;

  /// Sets `found` to the numbers of the points closer to `point` than `radius` [m], ascending.
  void within(const Imath::V3f& point, float radius, std::vector<std::uint32_t>& found) const;
  /// Sets `found` to the numbers of the `count` points nearest to `point`, or all if there are fewer, nearest
  /// first.
  void nearest(const Imath::V3f& point, std::size_t count, std::vector<std::uint32_t>& found) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace abbe
