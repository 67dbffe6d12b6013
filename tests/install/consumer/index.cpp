// Uses two of Abbe's libraries: asks for an index.
#include <cstdio>

#include "io/data_directory.h"
#include "materials/index/library.h"

int main() {
  abbe::set_data_directory(ABBE_DATA_DIR);
  abbe::Diagnostics diagnostics;
  const auto glass = abbe::load_index("N-BK7", {}, diagnostics);
  if (!glass) {
    std::fputs(diagnostics.text().c_str(), stderr);
    return 1;
  }
  std::printf("n_d of N-BK7: %.6f\n", glass->index.n(587.5618));
}
