// Pictures from MuJoCo's renderer: what is seen where, through which window. Needs no display.
#include "mujoco_ref/offscreen.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "core/log/hdf5/hdf5_error.hpp"
#include "experiments/mujoco/obstacle_geoms.hpp"
#include "experiments/mujoco/picture.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mujoco_model.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::offscreen_test {

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

/// What is seen at a place of the picture plane, cm.
Pixel pixel_at(const Image& image, const View& view, double right, double up) {
  const int column = static_cast<int>((right - view.low.x()) * view.scale);
  const int row = image.height - 1 - static_cast<int>((up - view.low.y()) * view.scale);
  const unsigned char* rgb = &image.rgb[3 * (static_cast<std::size_t>(row) * image.width + column)];
  return {rgb[0], rgb[1], rgb[2]};
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
  Pixel at(const Image& image, double x, double y) const { return pixel_at(image, view, x, y); }

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
    EXPECT_STREQ(error.what(), "picture of 280 x 200 px: the renderer can draw at most 100 x 100");
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

/// The Table 1 animal, straight.
Skin straight_skin(const Model& model) {
  Kinematics kin;
  update_positions(model, rest_state(model).q, kin);
  return skin_of(model, table1_specimen(), kin.centre);
}

TEST(PictureTest, SkinRunsHeadToTailWithRingsAtTheStations) {
  const Model model = table1_hagfish();
  const Specimen specimen = table1_specimen();
  const Skin skin = straight_skin(model);
  ASSERT_EQ(skin.rings(), skin_rings(model));
  ASSERT_EQ(skin.point.cols(), skin.rings() * skin.sides);
  // Round ends, by the radius beyond the outermost bodies' centres.
  EXPECT_NEAR(skin.point(0, 0), 0.212 - model.bodies.front().radius, 1e-5);
  EXPECT_NEAR(skin.point(0, skin.point.cols() - 1), 42.4 - 0.212 + model.bodies.back().radius,
              1e-5);
  for (int k = 0; k < skin.rings(); ++k) {
    const auto ring = skin.point.middleCols(k * skin.sides, skin.sides);
    const auto normal = skin.normal.middleCols(k * skin.sides, skin.sides);
    EXPECT_NEAR((normal.colwise().norm().array() - 1).abs().maxCoeff(), 0, 1e-6);
    const double x = ring.row(0).mean(), fraction = x / 42.4;
    if (x < 0.212 || x > 42.4 - 0.212) continue;  // of the round ends
    // Linear between bodies, the radius cuts the profile's corner at a station: 0.0026 cm at most
    // (0.0244 cm per cm over a quarter of a body).
    const double radius =
        profile(specimen.station, specimen.circumference, fraction) / (2 * std::numbers::pi);
    EXPECT_NEAR((ring.bottomRows<2>().colwise().norm().array() - radius).abs().maxCoeff(), 0, 3e-3);
    // Outward.
    EXPECT_GT(
        (normal.bottomRows<2>().cwiseProduct(ring.bottomRows<2>())).colwise().sum().minCoeff(), 0);
    double nearest = INFINITY;
    for (const double station : specimen.station) {
      nearest = std::min(nearest, std::abs(x - 42.4 * station));
    }
    const bool dark = skin.colour[k][0] < 128;
    // a ring is 0.26 cm wide; at its edge either colour is right
    if (nearest < 0.12) {
      EXPECT_TRUE(dark) << x;
    } else if (nearest > 0.14) {
      EXPECT_FALSE(dark) << x;
    }
  }
}

TEST(PictureTest, ColoursRunFromDarkToBrightWithTheQuantity) {
  const Model model = table1_hagfish();
  Skin skin = straight_skin(model);
  // From 0 at the head to more than the scale at the tail.
  paint(model, table1_specimen(), {0, 42.4}, Eigen::Vector2d(0, 2), 1, skin);
  EXPECT_EQ(skin.colour.back(), (std::array<unsigned char, 3>{253, 231, 37}));  // viridis' last
  EXPECT_LT(skin.colour.front()[0], 80);
  EXPECT_EQ(skin.colour[skin.rings() / 4 + 10][1] > skin.colour[20][1], true);
  paint(model, table1_specimen(), {0, 42.4}, Eigen::Vector2d(0, 0), 0, skin);
  EXPECT_EQ(skin.colour[1], (std::array<unsigned char, 3>{68, 1, 84}));  // and its first
}

TEST(PictureTest, ASkinIsDrawnWhereItIsInItsColours) {
  const Model model = table1_hagfish();
  Skin skin = straight_skin(model);
  for (auto& colour : skin.colour) colour = {0, 200, 0};
  const MujocoModel scene = skin_model(skin.rings(), skin.sides, 42.4);
  View view = turned_view(0, 0);
  Shown shown;
  shown.add(view, skin);
  fit(shown, 424, 100, view);
  OffscreenRenderer renderer(*scene.model(), 424, 100);
  const Image image = renderer.render({}, view, skin);
  const auto pixel = [&](double x, double y) { return pixel_at(image, view, x, y); };
  for (const double x : {0.5, 10.0, 30.0, 42.0}) {
    EXPECT_GT(pixel(x, 0)[1], pixel(x, 0)[0] + 40) << x;
    EXPECT_EQ(pixel(x, 2), white) << x;
    EXPECT_EQ(pixel(x, -2), white) << x;
  }
  const Image film = renderer.render({}, view, skin, "some words");
  EXPECT_EQ(scale_bar(view), 5);  // of 42.4 cm and its margin, a sixth is 7
  int black = 0;                  // px along the scale bar
  for (int x = 0; x < film.width; ++x) {
    const std::size_t at = 3 * (static_cast<std::size_t>(film.height - 46) * film.width + x);
    black += film.rgb[at] + film.rgb[at + 1] + film.rgb[at + 2] == 0 ? 1 : 0;
  }
  EXPECT_NEAR(black, 5 * view.scale, 1);
  EXPECT_EQ(renderer.render({}, view, skin).rgb, image.rgb);
  EXPECT_THROW(OffscreenRenderer(*skin_model(5, 8, 1).model(), 424, 100).render({}, view, skin),
               std::invalid_argument);
}

/// The window about the head plate alone.
View plate_view(double pitch, double yaw) {
  View view = turned_view(pitch, yaw);
  Shown shown;
  shown.add(view, plate_geom(true));
  fit(shown, view);
  return view;
}

TEST(PictureTest, TheWindowHoldsWhatIsShown) {
  // The plate alone, seen along its own axes: 0.5 cm by 5.2 cm behind x = 0.
  const View view = plate_view(0, 0);
  EXPECT_TRUE(view.right.isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(view.up.isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(view.toward().isApprox(Eigen::Vector3d::UnitZ()));
  // the margin is less than 0.1 cm, of which there are two
  EXPECT_LT(view.low.x(), -0.5);
  EXPECT_GT(view.low.x(), -0.6);
  EXPECT_LT(view.low.y(), -2.6);
  // With room for what looks larger since it is nearer, and for a whole pixel.
  EXPECT_NEAR(view.low.y(), -2.6 - 6.6 / view.scale, 0.6 / view.scale);
  EXPECT_NEAR(view.width / view.scale, 0.5 + 0.1, 0.1);
  EXPECT_NEAR(view.height / view.scale, 5.2 + 0.1, 0.1);
  // Turned by 90° about X the picture's up is -Z; by 90° about the vertical its right is -Z.
  EXPECT_TRUE(plate_view(90, 0).up.isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(plate_view(0, 90).right.isApprox(-Eigen::Vector3d::UnitZ()));
  // In a window of a given size it stands in the middle, as large as it can be.
  View wide = turned_view(0, 0);
  Shown shown;
  shown.add(wide, plate_geom(true));
  fit(shown, 600, 108, wide);
  EXPECT_NEAR(wide.scale, 100 / 5.2, 0.01);  // 4 px of margin above and below
  EXPECT_NEAR(wide.low.x() + 300 / wide.scale, -0.25, 1e-9);
  EXPECT_EQ(wide.width, 600);
}

/// A ring of 0.3 cm about a hole of 1 cm, both radii, about the X axis.
Obstacle ring_at(double x) {
  Strand ring;
  for (int k = 0; k < 32; ++k) {
    const double turn = 2 * std::numbers::pi * k / 32;
    ring.points.emplace_back(x, 1.3 * std::cos(turn), 1.3 * std::sin(turn));
  }
  ring.radius = 0.3;
  ring.closed = true;
  return {"ring", ring};
}

TEST_F(OffscreenTest, AHoleIsSeenThroughAndATubeIsCutOpen) {
  // The hole is where its rim is.
  const Obstacle plate{"plate", Plane{.point = {2, 0.5, 0}, .neck = 3}};
  const std::vector<DrawnObstacle> all = drawn_obstacles({plate, ring_at(1.7), ring_at(1.1)}, 40);
  const auto picture = [&](View& from, std::initializer_list<int> shown) {
    std::vector<mjvGeom> geoms;
    for (const int k : shown) {
      for (const mjvGeom& geom : obstacle_geoms(all[k], from.toward())) {
        geoms.push_back(geom);
      }
    }
    from.low = {-4, -4};
    from.width = from.height = 160;
    from.scale = 20;
    return OffscreenRenderer(*mirror.model(), 160, 160).render(geoms, from);
  };
  View front = turned_view(0, 90);  // against X; the plate is 5.2 cm wide
  const Image plate_alone = picture(front, {0}), with_rim = picture(front, {0, 1});
  for (const Eigen::Vector2d& edge :
       {Eigen::Vector2d{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {0.7, 0.7}}) {
    const auto seen = [&](const Image& image, double far) {
      return pixel_at(image, front, far * edge.x(), far * edge.y());
    };
    EXPECT_EQ(seen(plate_alone, 1.2), white);
    EXPECT_NE(seen(plate_alone, 1.4), white);
    EXPECT_EQ(seen(with_rim, 0.9), white);
    EXPECT_NE(seen(with_rim, 1.1), white);
    EXPECT_NE(seen(with_rim, 2.5), white);
    EXPECT_EQ(seen(with_rim, 3.8), white);
  }
  // A tube from the side: the half behind the middle is left, so that both edges show and the
  // viewer looks between them.
  View side = turned_view(0, 0);
  for (const mjvGeom& geom : obstacle_geoms(all[2], side.toward())) {
    EXPECT_LT(geom.pos[2], 0.05);
  }
  const Image tube = picture(side, {2});
  for (const double at : {-1.5, 0.0, 1.5}) EXPECT_NE(pixel_at(tube, side, 1.1, at), white) << at;
}

}  // namespace hagfish::offscreen_test
