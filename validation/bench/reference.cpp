#include "validation/bench/reference.h"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/data_directory.h"
#include "io/exr.h"
#include "io/text.h"
#include "spectral/rgb.h"
#include "transport/render/render.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

constexpr std::array kRgb{"R", "G", "B"};

Image render_reference(Scene scene, std::uint64_t seed, int samples, int threads) {
  expose_in_srgb(scene);
  scene.render.seed = seed;
  scene.render.samples = samples;
  RenderOptions options;
  options.threads = threads;
  return render(scene, options).film.image(scene.film_planes());
}

}  // namespace

Image linear_srgb(const Image& film) {
  Image image{film.width, film.height, {}, {}};
  const bool rgb = film.find("R") != nullptr;
  const Matrix3 matrix = rgb ? Matrix3() : rgb_to_xyz(kRec709).inverse();
  std::array<const ImageChannel*, 3> from{};
  for (std::size_t i = 0; i < 3; ++i) {
    from[i] = film.find(rgb ? kRgb[i] : std::array{"X", "Y", "Z"}[i]);
    if (from[i] == nullptr) throw Error(ErrorCode::internal, "film", "neither X, Y, Z nor R, G, B");
    image.channels.push_back({kRgb[i], std::vector<float>(film.pixels())});
  }
  for (std::size_t p = 0; p < film.pixels(); ++p) {
    const auto value = multiply(matrix, {from[0]->values[p], from[1]->values[p], from[2]->values[p]});
    for (std::size_t i = 0; i < 3; ++i) image.channels[i].values[p] = static_cast<float>(value[i]);
  }
  return image;
}

void expose_in_srgb(Scene& scene) {
  if (scene.channels.size() != 3 || scene.channels.front().name != "X") return;
  const Matrix3 matrix = rgb_to_xyz(kRec709).inverse();
  const std::vector<Channel> xyz = scene.channels;
  for (int i = 0; i < 3; ++i) {
    Curve weight(0.0);
    for (int j = 0; j < 3; ++j)
      weight = sum(weight, scaled(xyz[static_cast<std::size_t>(j)].weight, matrix[i][j]));
    scene.channels[static_cast<std::size_t>(i)] =
        energy_channel(kRgb[static_cast<std::size_t>(i)], std::move(weight));
  }
}

std::string ReferenceKey::text() const {
  return sha256(
      fmt::format("{} {}x{} {} {} {} {}", scene_sha256, width, height, version, data_sha256, seed, samples));
}

Reference reference_of(const Scene& scene, const fs::path& cache, const std::string& version,
                       std::uint64_t seed, int samples, int threads) {
  const ReferenceKey key{scene.sha256, scene.camera.width, scene.camera.height, version, data_sha256(), seed,
                         samples};
  std::error_code ignored;
  fs::create_directories(cache, ignored);
  const fs::path file = cache / (key.text() + ".exr");
  if (fs::is_regular_file(file, ignored)) return {read_exr(file), key.text(), true};
  require_writable(file);
  const Image image = render_reference(scene, seed, samples, threads);
  write_exr(file, image);
  return {image, key.text(), false};
}

}  // namespace abbe
