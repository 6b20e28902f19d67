// Pictures from MuJoCo's renderer: what is seen where, through which window. Needs no display.
#include "mujoco_ref/offscreen.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "core/log/hdf5_error.hpp"
#include "experiments/program/picture.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mujoco_model.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish {
namespace {

using Pixel = std::array<int, 3>;

constexpr double bend = std::numbers::pi / 2;  // of the moved chain's last joint, rad
constexpr Pixel white{255, 255, 255};

/// Two bodies 4 and 6 cm long, 0.5 cm thick, along +X from the origin, the second on a hinge about
/// Z.
Model small_chain() {
  Model model;
  for (const double length : {4.0, 6.0}) {
    Body body;
    body.mass = 1;
    body.length = length;
    body.radius = 0.25;
    body.inertia = cylinder_inertia(body.mass, body.length, body.radius);
    append_body(model, body, model.bodies.empty() ? std::vector<Axis>{} : std::vector{Axis::z});
    for (Hinge& hinge : model.hinges) hinge.lower = -(hinge.upper = 3);
  }
  return model;
}

class OffscreenTest : public testing::Test {
 protected:
  OffscreenTest() : mirror(mjcf_files(small_chain(), 1, 1e-3)) {
    view.right = Eigen::Vector3d::UnitX();
    view.up = Eigen::Vector3d::UnitY();
    view.low = {-2, -2};
    view.width = 280;
    view.height = 200;
    view.scale = 20;
  }

  /// The capsules of the chain with its hinge at `angle`, in pure red.
  std::vector<mjvGeom> chain(double angle) {
    mjData* data = mirror.data();
    data->qpos[7] = angle;
    mj_kinematics(mirror.model(), data);
    std::vector<mjvGeom> geoms(mirror.model()->ngeom);
    const float red[] = {1, 0, 0, 1};
    for (std::size_t g = 0; g < geoms.size(); ++g) {
      mjv_initGeom(&geoms[g], mjGEOM_CAPSULE, mirror.model()->geom_size + 3 * g,
                   data->geom_xpos + 3 * g, data->geom_xmat + 9 * g, red);
    }
    return geoms;
  }

  /// The pixel of a point (cm) of the picture plane.
  Pixel at(const Image& image, double x, double y) const {
    const int column = static_cast<int>((x - view.low.x()) * view.scale);
    const int row = image.height - 1 - static_cast<int>((y - view.low.y()) * view.scale);
    const unsigned char* rgb =
        &image.rgb[3 * (static_cast<std::size_t>(row) * image.width + column)];
    return {rgb[0], rgb[1], rgb[2]};
  }

  /// Lit skin: red, with no more green and blue than the white of a highlight adds.
  static bool is_skin(const Pixel& pixel) { return pixel[0] > 60 && pixel[0] > pixel[1] + 40; }

  MujocoModel mirror;
  View view;
};

TEST_F(OffscreenTest, SkinWhereABodyProjectsAndWhiteElsewhere) {
  OffscreenRenderer renderer(*mirror.model(), view.width, view.height);
  const Image image = renderer.render(chain(0), view);
  ASSERT_EQ(image.rgb.size(), 3u * 280 * 200);
  for (const double x : {0.5, 3.0, 5.0, 9.5}) {
    EXPECT_TRUE(is_skin(at(image, x, 0))) << x;
    EXPECT_EQ(at(image, x, 1), white) << x;
    EXPECT_EQ(at(image, x, -1), white) << x;
  }
  EXPECT_EQ(at(image, -1, 0), white);
  EXPECT_EQ(at(image, 11, 0), white);
}

TEST_F(OffscreenTest, TheSilhouetteIsToScale) {
  OffscreenRenderer renderer(*mirror.model(), view.width, view.height);
  const Image image = renderer.render(chain(0), view);
  int columns = 0, rows = 0;
  for (int i = 0; i < view.width; ++i)
    columns += at(image, view.low.x() + (i + 0.5) / 20, 0) != white;
  for (int i = 0; i < view.height; ++i)
    rows += at(image, 2, view.low.y() + (i + 0.5) / 20) != white;
  // A pixel at each edge may be covered in part; the lens and the corners of the silhouette are
  // worth less than a pixel more.
  EXPECT_NEAR(columns, 20 * 10.5, 3);
  EXPECT_NEAR(rows, 20 * 0.5, 3);
}

TEST_F(OffscreenTest, AMovedBodyMovesInThePicture) {
  OffscreenRenderer renderer(*mirror.model(), view.width, view.height);
  const Image straight = renderer.render(chain(0), view);
  const Image bent = renderer.render(chain(bend), view);
  EXPECT_TRUE(is_skin(at(straight, 8, 0)));
  EXPECT_EQ(at(bent, 8, 0), white);
  EXPECT_EQ(at(straight, 4, 4), white);
  EXPECT_TRUE(is_skin(at(bent, 4, 4)));
  EXPECT_TRUE(is_skin(at(bent, 2, 0)));
  EXPECT_EQ(renderer.render(chain(0), view).rgb, straight.rgb);
}

TEST_F(OffscreenTest, ABodyBeforeTheLightCastsAShadow) {
  OffscreenRenderer renderer(*mirror.model(), view.width, view.height);
  // A slab, and a plate 1 cm in front of its upper left, where the light comes from.
  const mjtNum slab_size[] = {4, 4, 0.1}, plate_size[] = {1, 1, 0.1};
  const mjtNum slab_at[] = {5, 3, 0}, plate_at[] = {4.5, 4.5, 2};
  const float red[] = {1, 0, 0, 1};
  std::vector<mjvGeom> geoms(2);
  mjv_initGeom(&geoms[0], mjGEOM_BOX, slab_size, slab_at, nullptr, red);
  mjv_initGeom(&geoms[1], mjGEOM_BOX, plate_size, plate_at, nullptr, red);
  const Image with = renderer.render(geoms, view);
  geoms.pop_back();
  const Image without = renderer.render(geoms, view);
  // Straight away from the light, (-0.25, 0.55, 0.8), the shadow's middle is at (5.1, 3.1); seen
  // just below the plate. The shadowed light is more than half of all: a fifth shows it is there.
  EXPECT_LT(at(with, 5.1, 3.1)[0], 0.8 * at(without, 5.1, 3.1)[0]);
  EXPECT_NEAR(at(with, 7.5, 1)[0], at(without, 7.5, 1)[0], 1);  // rounding
}

TEST_F(OffscreenTest, RefusesAViewBeyondItsBuffer) {
  OffscreenRenderer renderer(*mirror.model(), 100, 100);
  try {
    renderer.render(chain(0), view);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "picture of 280 x 200 px: the renderer goes to 100 x 100");
  }
  EXPECT_THROW(OffscreenRenderer(*mirror.model(), 100, 30000), std::runtime_error);
}

TEST_F(OffscreenTest, MissingOpenGlIsNamed) {
  // A process of its own: EGL looks for its libraries once.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/no/such/vendor.json", 1);
        try {
          OffscreenRenderer renderer(*mirror.model(), 100, 100);
        } catch (const std::runtime_error& error) {
          std::fprintf(stderr, "%s\n", error.what());
          std::_Exit(1);
        }
        std::_Exit(0);
      },
      testing::ExitedWithCode(1), "no off-screen OpenGL: egl[A-Za-z]+.*EGL error 0x");
}

TEST_F(OffscreenTest, PngHoldsTheImageAndNamesWhatCannotBeWritten) {
  const Image image{2, 1, {255, 0, 0, 0, 0, 255}};
  const TemporaryFolder folder;
  const std::string file = folder / "a.png";
  write_png(image, file);
  std::ifstream written(file, std::ios::binary);
  std::string magic(8, ' ');
  written.read(magic.data(), 8);
  EXPECT_EQ(magic, "\x89PNG\r\n\x1a\n");
  try {
    write_png(image, "/no/such/folder/a.png");
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_STREQ(error.what(),
                 "/no/such/folder/a.png: cannot be written: No such file or directory");
  }
}

TEST(PictureTest, SkinRunsHeadToTailWithRingsAtTheStations) {
  const Model model = table1_hagfish();
  const Specimen specimen = table1_specimen();
  Kinematics kin;
  update_positions(model, rest_state(model).q, kin);
  const std::vector<mjvGeom> geoms = skin_geoms(model, specimen, kin.centre);
  // Spheres from the first body's centre to the last one's, closer than a tenth of the radius.
  EXPECT_NEAR(geoms.front().pos[0], 0.212, 0.06);
  EXPECT_NEAR(geoms.back().pos[0], 42.4 - 0.212, 0.06);
  for (std::size_t g = 0; g < geoms.size(); ++g) {
    const double x = geoms[g].pos[0], fraction = x / 42.4;
    // Linear between bodies, the radius cuts the profile's corner at a station: 0.0026 cm at most
    // (0.0244 cm per cm over a quarter of a body).
    EXPECT_NEAR(
        geoms[g].size[0],
        profile(specimen.station, specimen.circumference, fraction) / (2 * std::numbers::pi), 3e-3);
    if (g > 0) {
      EXPECT_LT(x - geoms[g - 1].pos[0], 0.1 * geoms[g].size[0]);
    }
    double nearest = INFINITY;
    for (const double station : specimen.station) {
      nearest = std::min(nearest, std::abs(x - 42.4 * station));
    }
    const bool dark = geoms[g].rgba[0] < 0.5f;
    // a ring is 0.26 cm wide; at its edge either colour is right
    if (nearest < 0.12) {
      EXPECT_TRUE(dark) << x;
    } else if (nearest > 0.14) {
      EXPECT_FALSE(dark) << x;
    }
  }
}

TEST(PictureTest, TheWindowHoldsWhatIsShown) {
  // The plate alone, seen along its own axes: 0.5 cm by 5.2 cm behind x = 0.
  const View view = view_of({plate_geom(true)}, 0, 0);
  EXPECT_TRUE(view.right.isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(view.up.isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(view.toward().isApprox(Eigen::Vector3d::UnitZ()));
  // the margin is less than 0.1 cm, of which there are two
  EXPECT_LT(view.low.x(), -0.5);
  EXPECT_GT(view.low.x(), -0.6);
  EXPECT_LT(view.low.y(), -2.6);
  EXPECT_GT(view.low.y(), -2.7);
  EXPECT_NEAR(view.width / view.scale, 0.5 + 0.1, 0.1);
  EXPECT_NEAR(view.height / view.scale, 5.2 + 0.1, 0.1);
  // Turned by 90° about X the picture's up is -Z; by 90° about the vertical its right is -Z.
  EXPECT_TRUE(view_of({plate_geom(true)}, 90, 0).up.isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(view_of({plate_geom(true)}, 0, 90).right.isApprox(-Eigen::Vector3d::UnitZ()));
}

}  // namespace
}  // namespace hagfish
