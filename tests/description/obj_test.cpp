#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "mesh_files.h"
#include "scene/shapes/mesh.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

using test::Fault;
using test::Loaded;
using test::shaped;
using test::write;

class ObjTest : public test::MeshFileTest {};

constexpr const char* kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

// A gear with `corners` corners; every second one is on a tooth.
std::string gear(int corners) {
  std::string text;
  std::string face = "f";
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners;
    const double radius = 1 + 0.5 * (i % 2);
    text += fmt::format("v {} {} 0\n", radius * std::cos(angle), radius * std::sin(angle));
    face += fmt::format(" {}", i + 1);
  }
  return text + face + "\n";
}

TEST_F(ObjTest, ReadsFaces) {
  const Mesh cut =
      mesh("a.obj", std::string("# a comment\r\n") + kCorners +
                        "vn 0 0 1\nvt 0 0\ng part\nf 1/1/1 2/1/1 3/1/1\nf -4//1 -2//1 -1//1 2\n");
  const std::vector<std::array<std::uint32_t, 3>> expected{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
  EXPECT_EQ(cut.triangles, expected);
  EXPECT_EQ(cut.vertices.size(), 4U);
}

// A comment may follow anything; a "#" within a name does not begin one.
TEST_F(ObjTest, CommentsEndLines) {
  write(folder_ / "a.mtl", "newmtl red # 2\nKd 0.8 0.1 0.05\nnewmtl plain\nKd 0.5 0.5 0.5 # grey\n");
  const std::string text =
      "# all\nmtllib a.mtl # colours\nv 0 0 0 # first\nv 1 0 0#second\r\nv 0 1 0\t# third\n  # v 5 5 5\n"
      "usemtl red # 2\nf 1 2 3 # a face\nusemtl plain # the other\nf 3 2 1#f 1 1 1";
  const MeshFile file = read("a.obj", text, FileMaterials::wanted);
  ASSERT_EQ(file.submeshes.size(), 2U);
  EXPECT_EQ(file.submeshes[0].mesh.vertices[1], Imath::V3d(1, 0, 0));
  EXPECT_EQ(file.submeshes[1].mesh.triangles.size(), 1U);
}

TEST_F(ObjTest, LinesGoOnBehindABackslash) {
  const std::string text = "# C:\\objects\\\nv 0 0 0\nv 1 0 0\nv 1 1 \\\n 0\nv 0 1 0\nf 1 2 \\\r\n3\\\n4\n";
  EXPECT_DOUBLE_EQ(area(mesh("a.obj", text)), 1);
  expect_refused("a.obj", {{"a line behind it", text + "f 1 2 9\n", ErrorCode::input,
                            "line 10: no such vertex (got 9, allowed [1, 4])"}});
}

TEST_F(ObjTest, NumbersHaveAnyForm) {
  const Mesh read =
      mesh("a.obj", "v\t+1e2 -.5 5.\t\nv 1E-1  0.30000000000000004 -0 0.5 1 1 1 \r\nv 0 1 0\nf 1 2 3");
  EXPECT_EQ(read.vertices.at(0), Imath::V3d(100, -0.5, 5));
  EXPECT_EQ(read.vertices.at(1), Imath::V3d(0.1, 0.30000000000000004, 0));
}

TEST_F(ObjTest, PolygonsNeedNotBeConvex) {
  const std::string dented = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 0.2 0\nv 0 1 0\n";
  for (const char* face : {"f 1 2 3 4 5", "f 2 3 4 5 1", "f 3 4 5 1 2", "f 4 5 1 2 3", "f 5 1 2 3 4"}) {
    SCOPED_TRACE(face);
    const Mesh cut = mesh("a.obj", dented + face);
    EXPECT_EQ(cut.triangles.size(), 3U);
    EXPECT_NEAR(area(cut), 1.2, 1e-12);
    for (std::size_t i = 0; i < cut.triangles.size(); ++i) EXPECT_GT(area_vector(cut, i).z, 0);
  }
  const Mesh slit = mesh("a.obj",
                         "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\n"
                         "f 1 2 3 4 1 5 6 7 8 5\n");
  EXPECT_NEAR(area(slit), 12, 1e-12) << "a slit leads to a hole";
  const Mesh shaded = mesh("a.obj", dented +
                                        "vn 1 0 0\nvn 0 1 0\nvn 0 0 1\nvn -1 0 0\nvn 0 -1 0\n"
                                        "f 1//1 2//2 3//3 4//4 5//5\n");
  const std::vector<Imath::V3f> normals{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}};
  for (std::size_t i = 0; i < shaded.triangles.size(); ++i)
    for (std::size_t corner = 0; corner < 3; ++corner)
      EXPECT_EQ(shaded.normals.at(i).at(corner), normals.at(shaded.triangles[i].at(corner)));
}

TEST_F(ObjTest, ABentQuadrilateralIsCutAtItsFirstCorner) {
  const std::vector<std::array<std::uint32_t, 3>> fan{{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(mesh("a.obj", "v 0 0 0\nv 1 0 1\nv 1 1 0\nv 0 1 1\nf 1 2 3 4\n").triangles, fan);
  EXPECT_EQ(mesh("a.obj", "v 0 0 0\nv 1 1 1\nv 1 0 0\nv 0 1.5 0.3\nf 1 2 3 4\n").triangles, fan) << "twisted";
}

TEST_F(ObjTest, BringsItsMaterials) {
  write(folder_ / "a.mtl",
        "newmtl red paint\nKd 0.8 0.1 0.05\nKs 1 1 1\nNs 10\nillum 2\nKs 0.5 0.5 0.5\n"
        "newmtl plain\nKd 0.5 0.5 0.5\n");
  write(folder_ / "a.obj", std::string("mtllib a.mtl\n") + kCorners +
                               "usemtl red paint\nf 1 2 3\nusemtl plain\nf 1 2 4\nf 1 3 4\n");
  const Loaded loaded =
      load(R"({"units": "cm", "shapes": [{"mesh": "a.obj", "name": "thing", "transform": {"scale": 2}}]})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  ASSERT_EQ(loaded->shapes.size(), 2U);
  EXPECT_EQ(loaded->shapes[0].name, "thing/red paint");
  const auto& second = std::get<Mesh>(loaded->shapes[1].shape);
  EXPECT_EQ(second.vertices.size(), 4U);
  EXPECT_NEAR(area(second), 4e-4, 1e-12) << "two halves of a square of 2 cm";
  const auto& [from, along, up] = second.triangles.at(0);
  EXPECT_LT((second.vertices[up] - second.vertices[from] - Imath::V3d(0, 0, 0.02)).length(), 1e-12);
  EXPECT_LT((second.vertices[along] - second.vertices[from] - Imath::V3d(0.02, 0, 0)).length(), 1e-12);
  const Material& red = loaded->materials[loaded->shapes[0].material];
  EXPECT_EQ(red.name, "a.obj:red paint");
  const LinearRgb color = linear_rgb(std::get<DiffuseMaterial>(red.model).reflectance.curve());
  EXPECT_NEAR(color[0], 0.8, 1e-3);
  EXPECT_NEAR(color[1], 0.1, 1e-3);
  EXPECT_NEAR(color[2], 0.05, 1e-3);
  EXPECT_NE(loaded.text().find(
                "/shapes/0/mesh: warning: material \"red paint\" of \"a.obj\": Ks, Ns are not represented"),
            std::string::npos)
      << loaded.text();
  EXPECT_EQ(loaded.text().find("\"plain\""), std::string::npos) << "nothing of it is lost";

  write(folder_ / "two words.mtl", "newmtl plain\nKd 1 1 1\n");
  write(folder_ / "b.obj", std::string("mtllib two words.mtl\n") + kCorners + "usemtl plain\nf 1 2 3\n");
  EXPECT_TRUE(load(R"({"shapes": [{"mesh": "b.obj"}]})").scene);

  // The hash of the scene includes the materials.
  const std::string before = loaded->sha256;
  write(folder_ / "a.mtl", "newmtl red paint\nKd 0.8 0.1 0.06\nnewmtl plain\n");
  EXPECT_NE(
      load(R"({"units": "cm", "shapes": [{"mesh": "a.obj", "name": "thing", "transform": {"scale": 2}}]})")
          ->sha256,
      before);

  const Loaded own = load(shaped(R"("mesh": "a.obj")"));
  ASSERT_TRUE(own.scene) << own.text();
  EXPECT_EQ(own->shapes.size(), 1U) << "one material for all";
  EXPECT_EQ(own->materials.size(), 1U);
}

TEST_F(ObjTest, FilesOfMaterialsStandInOneLine) {
  write(folder_ / "a.mtl", "newmtl red\nKd 1 0 0\n");
  write(folder_ / "b.mtl", "newmtl blue\nKd 0 0 1\n");
  const std::string faces = std::string(kCorners) + "usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 4\n";
  for (const char* lines : {"mtllib a.mtl b.mtl\n", "mtllib a.mtl\tb.mtl # two\r\nmtllib b.mtl\n",
                            "mtllib a.mtl\nmtllib b.mtl a.mtl\n"}) {
    SCOPED_TRACE(lines);
    const MeshFile file = read("two.obj", lines + faces, FileMaterials::wanted);
    ASSERT_EQ(file.materials.size(), 2U);
    EXPECT_EQ(file.materials[0].name, "red");
    EXPECT_EQ(file.materials[1].name, "blue");
    EXPECT_EQ(file.others.size(), 2U);
  }
  write(folder_ / "a.mtl b.mtl", "newmtl red\nKd 1 1 1\nnewmtl blue\nKd 1 1 1\n");
  const MeshFile one = read("two.obj", "mtllib a.mtl b.mtl\n" + faces, FileMaterials::wanted);
  EXPECT_EQ(one.others.size(), 1U) << "a name with blanks";
  expect_refused("bad.obj", {{"blanks in a name that is missing", "mtllib my lost.mtl\n", ErrorCode::input,
                              "\"my lost.mtl\", which it names: no such file"},
                             {"a second that is missing", "mtllib a.mtl gone.mtl\n", ErrorCode::input,
                              "\"gone.mtl\", which it names: no such file"},
                             {"a second beyond the folder", "mtllib a.mtl ../b.mtl\n", ErrorCode::input,
                              "it may name only files in its folder or below (got \"../b.mtl\")"}});
}

TEST_F(ObjTest, PartsHaveMaterialsOfTheScene) {
  test::write(folder_ / "two.obj",
              "mtllib chair.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl wood\nf 1 2 3\nf 1 2 4\n"
              "usemtl wool\nf 1 3 4\n");
  test::write(folder_ / "chair.mtl", "newmtl wood\nKd 0.4 0.2 0.1\nnewmtl wool\nKd 1 1 1\n");
  const auto part = [](const char* of) {
    return shaped(fmt::format(R"("mesh": {{"file": "two.obj", "of_material": "{}"}})", of));
  };
  const Loaded wood = load(part("wood"));
  ASSERT_TRUE(wood.scene) << wood.text();
  EXPECT_EQ(std::get<Mesh>(wood->shapes.at(0).shape).triangles.size(), 2U);
  const Loaded none = load(part("wol"));
  EXPECT_FALSE(none.scene);
  EXPECT_NE(none.text().find("unknown material of the mesh file \"wol\"; did you mean \"wool\"?"),
            std::string::npos)
      << none.text();
}

TEST_F(ObjTest, RefusesBadFiles) {
  const auto in = ErrorCode::input;
  write(folder_ / "bad.mtl", "newmtl a\nKd 0.1 2 0\n");
  write(folder_ / "curve.mtl", "newmtl a\n  Kd spectral a.rfl\n");
  write(folder_ / "early.mtl", "Kd 0.1 0 0\n");
  expect_refused(
      "bad.obj",
      {{"an index beyond", std::string(kCorners) + "f 1 2 5\n", in,
        "line 5: no such vertex (got 5, allowed [1, 4])"},
       {"an index before", std::string(kCorners) + "f 1 2 -5\n", in, "no such vertex (got -5"},
       {"zero", std::string(kCorners) + "f 1 2 0\n", in, "no such vertex (got 0"},
       {"no number", std::string(kCorners) + "f 1 2 x\n", in,
        "line 5: a corner of a face (got \"x\", allowed v, v/vt, v//vn and v/vt/vn of whole numbers)"},
       {"no whole number", std::string(kCorners) + "f 1.5 2 3\n", in, "a corner of a face (got \"1.5\", "},
       {"half an index", std::string(kCorners) + "f 1/1-1 2 3\n", in, "a corner of a face (got \"1/1-1\", "},
       {"four indices", std::string(kCorners) + "f 1/1/1/1 2 3\n", in,
        "a corner of a face (got \"1/1/1/1\", "},
       {"edges that cross", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n", in,
        "line 5: a polygon of 4 corners whose edges cross"},
       {"more dents than can be cut", gear(16386), in,
        "a polygon of 16386 corners that is not convex (allowed 16384 or fewer)"},
       {"two corners", std::string(kCorners) + "f 1 2\n", in,
        "line 5: a face of 2 corners (allowed 3 or more)"},
       {"half a vertex", "v 1 2\nf 1 1 1\n", in, "line 1: vertex 1 needs three finite numbers (got 1 2)"},
       {"infinite", "v 1 2 inf\n", in, "three finite numbers"},
       {"not a number", "v 0 0 0\nv 1 nan 2\n", in,
        "line 2: vertex 2 needs three finite numbers (got 1 nan 2)"},
       {"a decimal comma", "v 4,5 0.25 1\n", in,
        "line 1: vertex 1 needs three finite numbers (got 4,5 0.25 1)"},
       {"letters behind a number", "v 1 0.5abc 1\n", in,
        "vertex 1 needs three finite numbers (got 1 0.5abc 1)"},
       {"two points", "v 1 2 2.5.9\n", in, "vertex 1 needs three finite numbers (got 1 2 2.5.9)"},
       {"a normal with a comma", "vn 0,6 0.8 1\n", in,
        "line 1: vn 1 needs three finite numbers (got 0,6 0.8 1)"},
       {"empty", "", in, "no faces"},
       {"no area", std::string(kCorners) + "f 1 1 2\n", in, "the mesh has no triangle of nonzero area"},
       {"missing library", "mtllib gone.mtl\n", in, "\"gone.mtl\", which it names: no such file"},
       {"climbing out", "mtllib ../a.mtl\n", in,
        "it may name only files in its folder or below (got \"../a.mtl\")"},
       {"absolute", "mtllib /etc/passwd\n", in, "in its folder or below (got \"/etc/passwd\")"},
       {"unknown material", "mtllib bad.mtl\n", in,
        "\"bad.mtl\" line 2: Kd (got 0.1 2 0, allowed three of [0, 1])"},
       {"a curve", "mtllib curve.mtl\n", in,
        "\"curve.mtl\" line 2: Kd (got spectral a.rfl, allowed three of [0, 1])"},
       {"a material without a name", "mtllib early.mtl\n", in,
        "line 1: \"early.mtl\" has a material without a name"},
       {"unknown material", std::string(kCorners) + "usemtl wod\nf 1 2 3\n", in,
        "line 5: unknown material \"wod\""},
       {"no material", std::string(kCorners) + "f 1 2 3\n", ErrorCode::scene,
        "triangles without a material"}});
  write(folder_ / "bad.stl", "solid");
  EXPECT_NE(load(shaped(R"("mesh": "bad.stl")"))
                .text()
                .find("unknown format (got \".stl\", allowed .ply, .ply.gz, .obj, .gltf, .glb)"),
            std::string::npos);
}

}  // namespace
}  // namespace abbe
