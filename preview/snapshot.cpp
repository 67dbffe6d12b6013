#include "preview/snapshot.h"

#include <atomic>

#include "transport/render/threads.h"

namespace abbe {

Snapshot take_snapshot(const Scene& scene, const FilmIdentity& identity, const RenderResult& result,
                       int threads) {
  const Film& film = result.film;
  Snapshot snapshot{result.stats.samples_per_pixel, film.crop(), {film.width(), film.height(), {}, identity}};
  for (const std::string& plane : scene.film_planes())
    snapshot.film.channels.push_back({plane, std::vector<float>(snapshot.film.pixels())});
  std::atomic<int> next_row = 0;
  run_on_threads(threads, [&] {
    for (int y = next_row++; y < film.height(); y = next_row++)
      for (int x = 0; x < film.width(); ++x) {
        const std::size_t pixel = film.pixel_at(x, y);
        for (int k = 0; k < film.channels(); ++k)
          snapshot.film.channels[static_cast<std::size_t>(k)].values[pixel] =
              static_cast<float>(film.mean(pixel, k));
      }
  });
  return snapshot;
}

}  // namespace abbe
