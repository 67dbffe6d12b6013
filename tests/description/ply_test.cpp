#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <locale>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description/meshes/mesh_formats.h"
#include "mesh_files.h"

namespace abbe {
namespace {

using PlyTest = test::DescriptionTest;
using test::Fault;
using test::kSquare;
using test::Loaded;
using test::ply;
using test::shaped;
using test::write;

TEST_F(PlyTest, ReadsPly) {
  const auto square = std::get<Mesh>(shape(R"("mesh": "bench.ply")"));
  EXPECT_EQ(square.vertices.size(), 4U);
  const std::vector<std::array<std::uint32_t, 3>> fan{{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(square.triangles, fan) << "a polygon is cut into triangles";
  EXPECT_DOUBLE_EQ(area(square), 1);

  const std::string binary = test::binary_ply();
  write(folder_ / "binary.ply", binary);
  EXPECT_DOUBLE_EQ(area(shape(R"("mesh": "binary.ply")")), 2);
  std::string infinite = binary;
  infinite[infinite.size() - 15] = '\x7F';  // high bytes of the last z
  infinite[infinite.size() - 16] = '\x80';
  write(folder_ / "binary.ply", infinite);
  EXPECT_NE(load(shaped(R"("mesh": "binary.ply")")).text().find("vertex 2 is not finite"), std::string::npos);
  write(folder_ / "binary.ply", binary.substr(0, binary.size() - 1));
  EXPECT_NE(load(shaped(R"("mesh": "binary.ply")")).text().find("declares more"), std::string::npos);
}

// The library would report these files as truncated.
TEST_F(PlyTest, CornersOfFewerBitsAreTold) {
  const std::string square = ply(4, 1, kSquare + "4 0 1 2 3\n");
  for (const char* type : {"uchar", "short", "uint16"}) {
    std::string narrow = square;
    narrow.replace(narrow.find("list uchar int"), 14, fmt::format("list uchar {}", type));
    write(folder_ / "narrow.ply", narrow);
    const std::string told = load(shaped(R"("mesh": "narrow.ply")")).text();
    EXPECT_NE(told.find(fmt::format(
                  "narrow.ply\": PLY header: the type of the corners of faces (got {}, allowed int, ", type)),
              std::string::npos)
        << told;
  }
  std::string textured = square;
  textured.replace(textured.find("end_header"), 0, "property list uchar short texcoord\n");
  textured.insert(textured.size() - 1, " 0");
  write(folder_ / "textured.ply", textured);
  EXPECT_DOUBLE_EQ(area(shape(R"("mesh": "textured.ply")")), 1) << "other lists are passed over";
}

TEST_F(PlyTest, PolygonsNeedNotBeConvex) {
  write(folder_ / "dented.ply", ply(4, 1, "0 0 0\n2 0 0\n2 1 0\n1 0.2 0\n4 0 1 2 3\n"));
  EXPECT_NEAR(area(shape(R"("mesh": "dented.ply")")), 0.7, 1e-7);
}

TEST_F(PlyTest, ReadsPlyWhateverTheLocale) {
  struct Comma : std::numpunct<char> {
    [[nodiscard]] char do_decimal_point() const override { return ','; }
  };
  write(folder_ / "half.ply", ply(3, 1, "0 0 0\n0.5 0 0\n0 0.5 0\n3 0 1 2\n"));
  const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
  const double half = area(shape(R"("mesh": "half.ply")"));
  std::locale::global(before);
  EXPECT_DOUBLE_EQ(half, 0.125);
}

// pbrt scenes have compressed files.
TEST_F(PlyTest, ReadsWhatIsPacked) {
  const auto packed = [this](const std::string& bytes) {
    write(folder_ / "packed.ply", bytes);
    EXPECT_EQ(std::system(fmt::format("gzip -f '{}'", (folder_ / "packed.ply").string()).c_str()), 0);
    std::ifstream file(folder_ / "packed.ply.gz", std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string good = packed(test::binary_ply());
  EXPECT_DOUBLE_EQ(area(shape(R"("mesh": "packed.ply.gz")")), 2);
  write(folder_ / "packed.PLY.GZ", good);
  EXPECT_DOUBLE_EQ(area(shape(R"("mesh": "packed.PLY.GZ")")), 2);
  std::string other = good;
  other[other.size() - 6] ^= 1;  // a bit of the checksum
  const std::vector<std::pair<std::string, const char*>> faults{
      {good.substr(0, good.size() - 9), "truncated: the compressed data are incomplete"},
      {good.substr(0, good.size() - 1), "truncated: the compressed data are incomplete"},
      {other, "damaged ("},
      {"", "is not a gzip file"},
      {test::binary_ply(), "is not a gzip file"},
      {packed("solid\n"), "malformed PLY header"}};
  for (const auto& [bytes, message] : faults) {
    write(folder_ / "packed.ply.gz", bytes);
    const Loaded loaded = load(shaped(R"("mesh": "packed.ply.gz")"));
    EXPECT_EQ(loaded.diagnostics.code(), ErrorCode::input);
    EXPECT_NE(loaded.text().find(message), std::string::npos) << message << ": " << loaded.text();
  }
  write(folder_ / "packed.ply.gz", good);
  const std::size_t size = test::binary_ply().size();
  for (const std::size_t limit : {size, size - 1}) {
    MemoryReservation held(nullptr, 0);
    std::string bytes;
    const auto fault = read_gzip_bytes(folder_ / "packed.ply.gz", limit, bytes, held);
    EXPECT_EQ(fault.has_value(), limit < size) << fault.value_or("");
  }
  Inputs inputs(std::size_t{1} << 19);
  Diagnostics diagnostics;
  EXPECT_THROW((void)load_mesh_file(folder_ / "packed.ply.gz", FileMaterials::ignored, {}, diagnostics,
                                    FileCoordinates::ignored, &inputs),
               Error);
}

TEST_F(PlyTest, RefusesBadPly) {
  const std::vector<Fault> faults{
      {"29 NaN", ply(4, 1, "0 0 0\n1 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), ErrorCode::input,
       "vertex 2 needs finite numbers (got \"nan\")"},
      {"30 index", ply(4, 1, kSquare + "3 0 1 4\n"), ErrorCode::input,
       "triangle 0 names a vertex that does not exist (got 4, allowed [0, 3])"},
      {"30 index of a polygon", ply(4, 1, kSquare + "4 0 1 2 99\n"), ErrorCode::input,
       "triangle 1 names a vertex that does not exist (got 99, allowed [0, 3])"},
      {"31 nothing left", ply(4, 1, kSquare + "3 0 1 1\n"), ErrorCode::input, "no triangle of nonzero area"},
      {"34 promises", ply(2147483647, 1, kSquare + "3 0 1 2\n"), ErrorCode::input,
       "the header declares more than the file holds"},
      {"34 more than memory",
       "ply\nformat ascii 1.0\nelement vertex 1000000000000000\nproperty float x\nproperty float y\nproperty "
       "float z\nend_header\n0\n",
       ErrorCode::input, "declares more"},
      {"34 a long list", ply(4, 1, kSquare + "4000000000 0 1 2\n"), ErrorCode::input, "declares more"},
      {"truncated", ply(4, 2, kSquare + "3 0 1 2\n"), ErrorCode::input, "declares more"},
      {"no faces", ply(4, 0, kSquare), ErrorCode::input, "no faces"},
      {"no PLY", "solid\n", ErrorCode::input, "malformed PLY header"},
      {"empty", "", ErrorCode::input, "malformed PLY header"},
      {"no end", "ply\nformat ascii 1.0\nelement vertex 3\n", ErrorCode::input, "malformed PLY header"},
      {"vertices of nothing",
       "ply\nformat ascii 1.0\nelement vertex 9\nelement face 1\nproperty list uchar int "
       "vertex_indices\nend_header\n3 0 1 2\n",
       ErrorCode::input, "malformed PLY header"},
      {"a property of nothing", "ply\nformat ascii 1.0\nproperty float x\nend_header\n", ErrorCode::input,
       "malformed PLY header"},
      {"an unknown type", "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n",
       ErrorCode::input, "malformed PLY header"},
      {"lists of any length",
       "ply\nformat ascii 1.0\nelement face 1\nproperty list uint int "
       "vertex_indices\nend_header\n1000000\n",
       ErrorCode::input, "lists counted in 32 bits"},
      {"a list of negative length",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 1\nproperty list char int vertex_indices\nend_header\n0 0 0\n-1\n",
       ErrorCode::input, "malformed PLY"},
      {"whole numbers for positions",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nproperty int "
       "z\nend_header\n0 0 0\n",
       ErrorCode::input, "PLY header: the type of x (got int, allowed float, float32, double, float64)"},
      {"whole numbers for normals",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
       "z\nproperty uchar nx\nend_header\n0 0 0 0\n",
       ErrorCode::input, "PLY header: the type of nx (got uchar"},
      {"no x",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float a\nproperty list uchar float x\nproperty "
       "float "
       "y\nproperty float z\nend_header\n0 1 0 0 0\n",
       ErrorCode::input, "PLY header: a vertex needs x, y and z (got a, y, z)"},
      {"capitals",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float X\nproperty float Y\nproperty float "
       "Z\nend_header\n0 0 0\n",
       ErrorCode::input, "PLY header: a vertex needs x, y and z (got X, Y, Z)"},
      {"no vertices",
       "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n3 0 1 2\n",
       ErrorCode::input, "PLY header: a vertex needs x, y and z (got none)"},
      {"edges that cross", ply(4, 2, kSquare + "4 0 1 2 3\n4 0 2 1 3\n"), ErrorCode::input,
       "face 1: a polygon of 4 corners whose edges cross"},
      {"no properties", "ply\nformat ascii 1.0\nelement vertex 9e300\nend_header\n", ErrorCode::input,
       "malformed PLY header"},
  };
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.what);
    write(folder_ / "bad.ply", fault.fragment);
    const Loaded loaded = load(shaped(R"("mesh": "bad.ply")"));
    EXPECT_FALSE(loaded.scene);
    EXPECT_EQ(loaded.diagnostics.code(), fault.code);
    EXPECT_NE(loaded.text().find(fault.message), std::string::npos) << loaded.text();
  }
  write(folder_ / "bad.ply", ply(4, 2, kSquare + "3 0 1 1\n3 0 1 2\n"));
  const Loaded kept = load(shaped(R"("mesh": "bad.ply")"));
  ASSERT_TRUE(kept.scene);
  EXPECT_EQ(std::get<Mesh>(kept->shapes[0].shape).triangles.size(), 1U);
  EXPECT_NE(kept.text().find("warning: triangles of zero area removed: 1"), std::string::npos);
}

}  // namespace
}  // namespace abbe
