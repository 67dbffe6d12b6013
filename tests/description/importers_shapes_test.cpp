// Shapes of other renderers' scenes: which side of them is the front, how images lie on them, and what of
// matter within matter is told.
#include <array>
#include <cmath>
#include <string>

#include "mitsuba_scenes.h"
#include "pbrt_scenes.h"

namespace abbe {
namespace {

using test::MitsubaTest;
using test::PbrtTest;
using test::QuadBody;
using test::whole;

// A triangle whose order says -z, with these normals at its corners.
std::string clockwise_ply(const std::string& normals) {
  const bool has = !normals.empty();
  const std::string properties = "property float nx\nproperty float ny\nproperty float nz\n";
  const std::string at = has ? " " + normals : "";
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
         (has ? properties : "") +
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n-1 -1 0" + at + "\n1 -1 0" +
         at + "\n0 1 0" + at + "\n3 0 2 1\n";
}

// That of the first triangle, which is of the scene: of a file 0.
double front_z(const spec::MeshBody& body) {
  const auto* mesh = std::get_if<spec::InlineMesh>(&body.surface.value);
  if (mesh == nullptr) return 0;
  const auto at = [&](std::size_t i) {
    const auto& [x, y, z] = mesh->vertices.at(mesh->triangles.at(0).at(i));
    return Imath::V3d(x, y, z);
  };
  return (at(1) - at(0)).cross(at(2) - at(0)).z;
}

TEST_F(PbrtTest, NormalsSayWhichSideEmits) {
  const std::string light = "AreaLightSource \"diffuse\"\n";
  const std::string triangle =
      "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  0 1 0] \"integer indices\" [0 2 1] ";
  const std::string up = "\"normal N\" [0 0 1  0 0 1  0 0 1]\n";
  const auto front = [&](const std::string& world) { return front_z(shape<spec::MeshBody>(world)); };
  EXPECT_LT(front(light + triangle + "\n"), 0);
  EXPECT_GT(front(light + triangle + up), 0);
  EXPECT_GT(front(light + "Scale -1 1 1\n" + triangle + up), 0);
  EXPECT_LT(front(light + "ReverseOrientation\n" + triangle + up), 0);
  EXPECT_LT(front(triangle + up), 0) << "what does not emit looks alike from both sides";
  EXPECT_FALSE(tells("both sides")) << told_;
  EXPECT_LT(front("AreaLightSource \"diffuse\" \"bool twosided\" true\n" + triangle + up), 0);
  put("cw.ply", clockwise_ply("0 0 1"));
  const std::string file = "Shape \"plymesh\" \"string filename\" \"cw.ply\"\n";
  EXPECT_GT(front(light + file), 0);
  EXPECT_TRUE(tells("is copied as triangles into the scene: its vertex normals are dropped")) << told_;
  EXPECT_EQ(front(light + "ReverseOrientation\n" + file), 0) << "stays a file";
  const auto patch = shape<QuadBody>(light +
                                     "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0] "
                                     "\"normal N\" [0 0 -1  0 0 -1  0 0 -1  0 0 -1]\n");
  EXPECT_LT(patch.surface.edge_u.cross(patch.surface.edge_v).z, 0);
  EXPECT_TRUE(tells("vertex normals in the scene file are not supported: dropped")) << told_;
}

TEST_F(PbrtTest, NormalsOnBothSidesAreTold) {
  const auto front = [&](const std::string& far) {
    return front_z(shape<spec::MeshBody>(
        "AreaLightSource \"diffuse\"\nShape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  " + far +
        "] \"integer indices\" [0 2 1  3 2 1] "
        "\"normal N\" [0 0 1  0 0 1  0 0 1  0 0 1]\n"));
  };
  const std::string told = "vertex normals of a light are on both sides of its triangles";
  EXPECT_GT(front("0.6 0.6 0"), 0) << "an area of 0.5 against one of 0.1";
  EXPECT_TRUE(tells(told)) << told_;
  EXPECT_LT(front("9 9 0"), 0) << "an area of 0.5 against one of 8.5";
  EXPECT_TRUE(tells(told)) << told_;
}

TEST_F(MitsubaTest, NormalsSayWhichSideEmits) {
  const auto front = [&](const std::string& normals, const std::string& more) {
    put("cw.ply", clockwise_ply(normals));
    return front_z(shape<spec::MeshBody>(
        R"(<shape type="ply"><string name="filename" value="cw.ply"/><emitter type="area"/>)" + more +
        "</shape>"));
  };
  const std::string flipped = R"(<boolean name="flip_normals" value="true"/>)";
  const std::string mirrored = R"(<transform name="to_world"><scale x="-1"/></transform>)";
  EXPECT_EQ(front("", ""), 0) << "stays a file, whose order says -z";
  EXPECT_GT(front("0 0 1", ""), 0);
  EXPECT_EQ(front("0 0 1", flipped), 0);
  EXPECT_EQ(front("0 0 1", R"(<boolean name="face_normals" value="true"/>)"), 0);
  EXPECT_GT(front("0 0 1", mirrored), 0);
  EXPECT_LT(front("0 0 -1", mirrored), 0);
  EXPECT_GT(front("", mirrored), 0) << "the order of what is placed says so there";
}

TEST_F(MitsubaTest, ImagesOnDiscsAndCubesLieAsTheyDo) {
  put_image("photo.exr", false);
  const auto mesh = [&](const std::string& shape) {
    const auto body = this->shape<spec::MeshBody>(
        "<shape " + shape +
        R"(<bsdf type="diffuse"><texture name="reflectance" type="bitmap"><string name="filename" value="photo.exr"/></texture></bsdf><emitter type="area"/></shape>)");
    return std::get<spec::InlineMesh>(body.surface.value);
  };
  const auto expect_polar = [](const spec::InlineMesh& disc, double turned) {
    for (std::size_t i = 0; i < disc.vertices.size(); ++i) {
      const auto& [x, y, z] = disc.vertices[i];
      const auto& [u, v] = disc.uv->value.at(i);
      EXPECT_NEAR(u, std::hypot(x, y), 1e-12);
      EXPECT_NEAR(u * std::cos(2 * M_PI * v), x, 1e-12);
      EXPECT_NEAR(u * std::sin(2 * M_PI * v), turned * y, 1e-12);
    }
  };
  expect_polar(mesh(R"(type="disk">)"), 1);
  EXPECT_TRUE(tells("or an image is replaced by triangles")) << told_;
  expect_polar(mesh(R"(type="disk"><boolean name="flip_normals" value="true"/>)"), 1);
  expect_polar(mesh(R"(type="disk"><transform name="to_world"><scale y="-1"/></transform>)"), -1);
  // Their points with u = v = 0, and whence u and v grow.
  struct Side {
    Imath::V3d origin, u, v;
  };
  const std::array<Side, 6> sides{{{{-1, -1, 1}, {0, 2, 0}, {2, 0, 0}},
                                   {{-1, 1, -1}, {0, -2, 0}, {2, 0, 0}},
                                   {{1, -1, 1}, {0, 2, 0}, {0, 0, -2}},
                                   {{-1, -1, -1}, {0, 2, 0}, {0, 0, 2}},
                                   {{1, 1, 1}, {-2, 0, 0}, {0, 0, -2}},
                                   {{-1, -1, -1}, {0, 0, 2}, {2, 0, 0}}}};
  const spec::InlineMesh cube = mesh(R"(type="cube">)");
  ASSERT_EQ(cube.vertices.size(), 24U);
  std::size_t found = 0;
  for (const Side& side : sides)
    for (std::size_t first = 0; first < cube.vertices.size(); first += 4) {
      bool alike = true;
      for (std::size_t i = first; i < first + 4; ++i) {
        const auto& [x, y, z] = cube.vertices[i];
        const auto& [u, v] = cube.uv->value.at(i);
        alike = alike && (side.origin + side.u * u + side.v * v - Imath::V3d(x, y, z)).length() < 1e-12;
      }
      found += alike;
    }
  EXPECT_EQ(found, 6U);
}

TEST_F(MitsubaTest, StretchedFilesKeepTheirImages) {
  put_image("photo.exr", false);
  put("q.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 0.5\nvt 0 0.5\nvn 0 0.1 1\n"
      "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n");
  const std::string stretched =
      R"(<shape type="obj"><string name="filename" value="q.obj"/><transform name="to_world"><scale x="2"/></transform>)";
  const std::string painted =
      stretched +
      R"(<bsdf type="diffuse"><texture name="reflectance" type="bitmap"><string name="filename" value="photo.exr"/></texture></bsdf>)";
  const auto expect_kept = [](const spec::MeshBody& body) {
    const auto& mesh = std::get<spec::InlineMesh>(body.surface.value);
    ASSERT_TRUE(mesh.uv);
    ASSERT_EQ(mesh.uv->value.size(), mesh.vertices.size());
    ASSERT_EQ(mesh.triangles.size(), 2U);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      EXPECT_NEAR(mesh.uv->value[i][0], mesh.vertices[i][0] / 2, 1e-6);
      EXPECT_NEAR(mesh.uv->value[i][1], mesh.vertices[i][1] / 2, 1e-6);
    }
  };
  expect_kept(shape<spec::MeshBody>(painted + R"(<emitter type="area"/></shape>)"));
  EXPECT_TRUE(tells("its vertex normals are dropped")) << told_;
  const auto grouped = [](const std::string& member) {
    return R"(<shape type="shapegroup" id="g">)" + member +
           R"(</shape></shape><shape type="instance"><ref id="g"/></shape>)";
  };
  const spec::Scene made = scene(grouped(painted));
  ASSERT_EQ(made.objects.size(), 1U);
  expect_kept(std::get<spec::MeshBody>(made.objects[0].value.shapes.at(0).kind));
  const spec::Scene bare = scene(grouped(stretched));
  const auto& body = std::get<spec::MeshBody>(bare.objects.at(0).value.shapes.at(0).kind);
  EXPECT_EQ(std::get<spec::InlineMesh>(body.surface.value).vertices.size(), 4U);
}

TEST_F(MitsubaTest, GroupsMayStandInTheirInstance) {
  const auto names = [&](const std::string& id) {
    const spec::Scene made = scene(
        R"(<shape type="instance"><shape type="shapegroup")" + id +
        R"(><shape type="sphere"/></shape></shape><shape type="instance"><shape type="shapegroup"><shape type="cube"/></shape></shape>)");
    std::string all;
    for (std::size_t i = 0; i < made.shapes.size(); ++i) {
      EXPECT_EQ(std::get<spec::Instance>(made.shapes[i].kind).of.value, made.objects.at(i).name);
      all += made.objects[i].name + ";";
    }
    return all;
  };
  EXPECT_EQ(names(""), "shape group 1;shape group 2;");
  EXPECT_EQ(names(R"( id="g")"), "g;shape group 2;");
}

const char* const kTurned = "a medium fills a reversed shape";

TEST_F(MitsubaTest, HollowsAreTold) {
  const auto told_of = [&](const std::string& parts) {
    (void)scene(R"(<shape type="sphere">)" + parts + "</shape>");
    return tells(kTurned);
  };
  const std::string turned = R"(<boolean name="flip_normals" value="true"/>)";
  EXPECT_FALSE(told_of(R"(<bsdf type="dielectric"/>)")) << told_;
  EXPECT_TRUE(told_of(turned + R"(<bsdf type="dielectric"/>)")) << told_;
  EXPECT_TRUE(told_of(turned + R"(<bsdf type="null"/><medium name="interior" type="homogeneous"/>)"))
      << told_;
  EXPECT_FALSE(told_of(turned)) << told_;
  EXPECT_TRUE(told_of(
      turned +
      R"(<bsdf type="dielectric"/><transform name="to_world"><scale x="2" y="1" z="1"/></transform>)"))
      << told_;
  EXPECT_FALSE(tells("of its content (")) << "not twice: " << told_;
}

TEST_F(PbrtTest, HollowsAreTold) {
  const std::string ball = "Material \"dielectric\"\nShape \"sphere\"\n";
  (void)scene(ball);
  EXPECT_FALSE(tells(kTurned)) << told_;
  (void)scene("ReverseOrientation\n" + ball);
  EXPECT_TRUE(tells(kTurned)) << told_;
  (void)scene("ReverseOrientation\nShape \"sphere\"\n");
  EXPECT_FALSE(tells(kTurned)) << told_;
}

}  // namespace
}  // namespace abbe
