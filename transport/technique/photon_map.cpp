#include "transport/technique/photon_map.h"

#include <algorithm>
#include <utility>

#include <nanoflann.hpp>

namespace abbe {

struct PhotonMap::Tree {
  // Point cloud in the interface that nanoflann requires.
  struct Cloud {
    std::vector<Imath::V3f> points;

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return points[i][static_cast<int>(axis)];
    }
    template <typename Box>
    bool kdtree_get_bbox(Box& /*box*/) const {
      return false;  // not computed yet
    }
  };

  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3,
                                                    std::uint32_t>;

  explicit Tree(std::vector<Imath::V3f> points) : cloud{std::move(points)}, index(3, cloud) {}
  Cloud cloud;
  Index index;  // index of `cloud`, which it references
};

PhotonMap::PhotonMap(std::vector<Imath::V3f> points) : tree_(std::make_unique<Tree>(std::move(points))) {}
PhotonMap::~PhotonMap() = default;
PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap& PhotonMap::operator=(PhotonMap&&) noexcept = default;

std::size_t PhotonMap::size() const {
  return tree_->cloud.points.size();
}

void PhotonMap::within(const Imath::V3f& point, float radius, std::vector<std::uint32_t>& found) const {
  thread_local std::vector<std::pair<std::uint32_t, float>> matches;
  found.clear();
  if (size() == 0) return;
  nanoflann::SearchParams params;
  params.sorted = false;
  tree_->index.radiusSearch(&point.x, radius * radius, matches, params);
  for (const auto& [number, squared_distance] : matches) found.push_back(number);
  std::sort(found.begin(), found.end());
}

void PhotonMap::nearest(const Imath::V3f& point, std::size_t count, std::vector<std::uint32_t>& found) const {
  thread_local std::vector<float> squared_distances;
  found.resize(std::min(count, size()));
  if (found.empty()) return;
  squared_distances.resize(found.size());
  found.resize(tree_->index.knnSearch(&point.x, found.size(), found.data(), squared_distances.data()));
}

}  // namespace abbe
