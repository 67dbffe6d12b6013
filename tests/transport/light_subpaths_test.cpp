#include "transport/technique/bidirectional.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace abbe {
namespace {

using Imath::V3f;

constexpr std::size_t kPaths = 150;  // three batches, the last one not full

V3f place_of(std::size_t path, std::size_t vertex) {
  return {static_cast<float>(path), static_cast<float>(vertex), 0};
}

// A light, then in turn a diffuse surface, a mirror and fog.
PathVertex vertex_at(const V3f& point, std::size_t number) {
  if (number == 0) return {.at = LightVertex{0, point}};
  if (number % 3 == 0) return {.at = MediumVertex{point, {0, 0, -1}, {}}};
  Bsdf bsdf = DiffuseBsdf{SampledSpectrum(0.5F)};
  if (number % 3 == 2) bsdf = MirrorBsdf{SampledSpectrum(0.5F)};
  return {.at = SurfaceVertex({point, {0, 0, 1}, 0, 0}, Basis<float>(V3f(0, 0, 1)), {0, 0, 1}, bsdf)};
}

// Number of vertices of a path: up to four more than `most - 4`, or none.
std::size_t vertices_of(std::size_t path, std::size_t most) {
  return path % 7 == 0 ? 0 : most - path % 5;
}

// Stores the batches from the last to the first, as threads may.
void keep_all(LightSubpaths& paths, std::size_t most) {
  PathPacket packet;
  packet.hero = 3;
  paths.begin(kPaths, packet, 0.25F);
  for (std::size_t batch = 3; batch-- > 0;) {
    std::vector<RecordedPath> recorded;
    for (std::size_t path = batch * kBatchSize; path < std::min(kPaths, (batch + 1) * kBatchSize); ++path) {
      const auto number = static_cast<std::uint32_t>(path);
      RecordedPath& one = recorded.emplace_back(Sampler(1, Purpose::light, 0, 0, number), number);
      for (std::size_t k = 0; k < vertices_of(path, most); ++k)
        one.vertices.push_back(vertex_at(place_of(path, k), k));
    }
    paths.store(batch, recorded);
  }
  paths.finish(1.5F);
}

TEST(LightSubpaths, AreThoseThatWereRecorded) {
  LightSubpaths paths;
  keep_all(paths, 6);
  ASSERT_EQ(paths.size(), kPaths);
  EXPECT_EQ(paths.packet().hero, 3);
  EXPECT_EQ(paths.time(), 0.25F);
  for (std::size_t path = 0; path < kPaths; ++path) {
    const LightSubpaths::Path stored = paths[path];
    ASSERT_EQ(stored.vertices.size(), vertices_of(path, 6)) << path;
    for (std::size_t k = 0; k < stored.vertices.size(); ++k)
      EXPECT_EQ(point_of(stored.vertices[k]), place_of(path, k)) << path;
    const Sampler own(1, Purpose::light, 0, 0, static_cast<std::uint32_t>(path));
    EXPECT_EQ(stored.sampler.group(5), own.group(5)) << path;
  }
}

TEST(LightSubpaths, FindByPlaceWhatScatters) {
  LightSubpaths paths;
  keep_all(paths, 6);
  std::vector<LightSubpaths::Vertex> found;
  paths.find_nearby(place_of(80, 1), found);
  // Only the diffuse vertices 1 and 4 of the paths 79, 80 and 81 are found; not lights, mirrors and fog.
  ASSERT_EQ(found.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found[i].path, 79 + i);
    EXPECT_EQ(found[i].number, 1U);
  }
  paths.find_nearby(place_of(80, 4), found);
  ASSERT_EQ(found.size(), 2U);  // path 79 has no vertex 4
  EXPECT_EQ(found[0].number, 4U);
}

TEST(LightSubpaths, ThoseOfTheNextSampleTakeOverTheirMemory) {
  LightSubpaths paths;
  keep_all(paths, 6);
  const PathVertex* before = paths[1].vertices.data();
  keep_all(paths, 5);
  EXPECT_EQ(paths[1].vertices.data(), before);
  EXPECT_EQ(paths[2].vertices.size(), 3U);
  std::vector<LightSubpaths::Vertex> found;
  paths.find_nearby(place_of(80, 4), found);
  EXPECT_EQ(found.size(), 1U);
}

}  // namespace
}  // namespace abbe
