// Uses Abbe's libraries as a project of its own: asks for an index, renders a scene to a film and a picture.
#include <cstdio>
#include <string>
#include <vector>

#include "calibration/output/display.h"
#include "description/load.h"
#include "io/data_directory.h"
#include "io/exr.h"
#include "io/picture.h"
#include "materials/index/library.h"
#include "sensor/response/channel.h"
#include "transport/render/render.h"

int main(int argc, char** argv) {
  if (argc != 4) return 2;  // SCENE FILE.exr FILE.png
  abbe::set_data_directory(ABBE_DATA_DIR);
  abbe::Diagnostics diagnostics;
  const auto glass = abbe::load_index("N-BK7", {}, diagnostics);
  const auto scene = abbe::load_scene(argv[1], {}, diagnostics);
  if (!glass || !scene) {
    std::fputs(diagnostics.text().c_str(), stderr);
    return 1;
  }
  std::printf("n_d of N-BK7: %.6f\n", glass->index.n(587.5618));

  std::vector<std::string> names;
  for (const abbe::Channel& channel : scene->channels) names.push_back(channel.name);
  const abbe::Image film = abbe::render(*scene, {}).film.image(names);
  abbe::write_exr(argv[2], film);
  const abbe::DisplayTransform display =
      abbe::make_display(scene->channels, scene->lights.front().emission.curve());
  abbe::write_picture(argv[3], display(film).image);
}
