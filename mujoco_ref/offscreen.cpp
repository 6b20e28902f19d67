#include "mujoco_ref/offscreen.hpp"

// Without X11, whose macros would follow.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/input/input_error.hpp"
#include "core/log/hdf5/hdf5_error.hpp"

namespace hagfish {
namespace {

using Eigen::Vector3d;

// px; MuJoCo ends the program where OpenGL refuses the buffer, which software does beyond 16384.
constexpr int largest_side = 8192;
constexpr double lens = 50;    // distance of the camera, in extents of the model
constexpr double reach = 1.5;  // of the clipping planes to either side of the middle, likewise

[[noreturn]] void fail(const std::string& step, const std::string& reason) {
  throw InputError(fmt::format("no off-screen OpenGL: {}: {}", step, reason));
}

void check_egl(bool done, const std::string& step) {
  if (!done) fail(step, fmt::format("EGL error {:#x}", eglGetError()));
}

/// An OpenGL context without any surface, current while it lives.
class EglContext {
 public:
  EglContext() {
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    check_egl(display_ != EGL_NO_DISPLAY, "eglGetPlatformDisplay (surfaceless)");
    check_egl(eglInitialize(display_, nullptr, nullptr) == EGL_TRUE, "eglInitialize");
    check_egl(eglBindAPI(EGL_OPENGL_API) == EGL_TRUE, "eglBindAPI");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    check_egl(eglChooseConfig(display_, wanted, &config, 1, &found) == EGL_TRUE, "eglChooseConfig");
    if (found == 0) fail("eglChooseConfig", "no configuration has OpenGL");
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, nullptr);
    check_egl(context_ != EGL_NO_CONTEXT, "eglCreateContext");
    if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      const EGLint error = eglGetError();
      eglDestroyContext(display_, context_);
      fail("eglMakeCurrent", fmt::format("EGL error {:#x}", error));
    }
  }
  // The display stays: it is the process's, and to end it would end whatever else uses it.
  ~EglContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
using ModelCopy = std::unique_ptr<mjModel, DeleteModel>;

/// `model` with the settings of the renderer.
ModelCopy with_settings(const mjModel& model, int width, int height,
                        const PictureQuality& quality) {
  if (width > largest_side || height > largest_side) {
    throw std::runtime_error(fmt::format("picture of {} x {} px: more than {} px on a side", width,
                                         height, largest_side));
  }
  ModelCopy copy(mj_copyModel(nullptr, &model));
  if (!copy) fail("mj_copyModel", "out of memory");
  mjVisual& visual = copy->vis;
  visual.global.offwidth = width;
  visual.global.offheight = height;
  visual.quality.offsamples = 4;  // all that Mesa's software renderer has
  // A silhouette of 32 corners is within 0.5 % of the radius.
  visual.quality.numslices = 32;
  visual.quality.numstacks = 12;
  visual.quality.shadowsize = quality.shadow_size;
  // The shadow map is a square about what is shown, to this many extents either side: enough for
  // the straight animal with the head plate, and no texel wasted.
  visual.map.shadowclip = 0.6f;
  return copy;
}

void set(float* to, const Vector3d& from) { Eigen::Vector3f::Map(to) = from.cast<float>(); }

void set(float* to, double grey) { std::fill_n(to, 3, static_cast<float>(grey)); }

/// The lights of mjvScene are directional, towards `middle` along `from` (world, unit).
mjvLight& add_light(mjvScene& scene, const Vector3d& middle, const Vector3d& from, double far) {
  mjvLight& light = scene.lights[scene.nlight++];
  light = {};
  // Shadows are looked for between the camera's clipping planes, so the light is as far away.
  set(light.pos, middle + far * from);
  set(light.dir, -from);
  light.attenuation[0] = 1;
  light.cutoff = 180;
  light.directional = 1;
  return light;
}

/// A ring of lights above the viewer's left shoulder, whose shadows overlap to a soft one, and a
/// weak one without shadow from the other side.
void set_lights(mjvScene& scene, const View& view, const Vector3d& middle, double far, int ring) {
  const double spread = ring > 1 ? 0.12 : 0;  // of the ring, of the unit distance
  const auto from = [&](double right, double up, double toward) {
    return Vector3d((right * view.right + up * view.up + toward * view.toward()).normalized());
  };
  for (int k = 0; k < ring; ++k) {
    const double turn = 2 * std::numbers::pi * k / ring;
    const Vector3d place =
        from(-0.25 + spread * std::cos(turn), 0.55 + spread * std::sin(turn), 0.8);
    mjvLight& light = add_light(scene, middle, place, far);
    set(light.diffuse, 0.62 / ring);
    set(light.specular, 0.5 / ring);
    light.castshadow = 1;
  }
  mjvLight& fill = add_light(scene, middle, from(0.5, -0.15, 0.85), far);
  set(fill.diffuse, 0.28);
  set(fill.ambient, 0.34);
}

void set_camera(mjvScene& scene, const View& view, const Vector3d& middle, double extent) {
  const double far = lens * extent;
  const double nearest = far - reach * extent;
  const double half = 0.5 * view.height / view.scale * nearest / far;
  for (mjvGLCamera& eye : scene.camera) {
    set(eye.pos, middle + far * view.toward());
    set(eye.forward, -view.toward());
    set(eye.up, view.up);
    eye.frustum_center = 0;
    eye.frustum_bottom = static_cast<float>(-half);
    eye.frustum_top = static_cast<float>(half);
    eye.frustum_near = static_cast<float>(nearest);
    eye.frustum_far = static_cast<float>(far + reach * extent);
  }
}

/// MuJoCo clears to black: a white wall behind everything that shines by itself.
mjvGeom backdrop(const View& view, const Vector3d& middle, double extent) {
  const Vector3d centre = middle - 0.99 * reach * extent * view.toward();
  const double half = std::max(view.width, view.height) / view.scale;
  const mjtNum size[] = {half, half, 0.001 * extent};
  Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor> axes;
  axes << view.right, view.up, view.toward();
  const float white[] = {1, 1, 1, 1};
  mjvGeom geom;
  mjv_initGeom(&geom, mjGEOM_BOX, size, centre.data(), axes.data(), white);
  geom.emission = 1;
  return geom;
}

/// The point of the middle of the window at half the depth of the geoms' centres and the skin.
Vector3d middle_of(const std::vector<mjvGeom>& geoms, const View& view, const Skin* skin) {
  double low = INFINITY, high = -INFINITY;
  const auto see = [&](const Vector3d& place) {
    const double depth = place.dot(view.toward());
    low = std::min(low, depth);
    high = std::max(high, depth);
  };
  for (const mjvGeom& geom : geoms) see(Eigen::Map<const Eigen::Vector3f>(geom.pos).cast<double>());
  for (Eigen::Index k = 0; skin != nullptr && k < skin->point.cols(); ++k) {
    see(skin->point.col(k).cast<double>());
  }
  const Eigen::Vector2d half = 0.5 / view.scale * Eigen::Vector2d(view.width, view.height);
  const Eigen::Vector2d centre = view.low + half;
  const double depth = low <= high ? 0.5 * (low + high) : 0;
  return centre.x() * view.right + centre.y() * view.up + depth * view.toward();
}

/// A scene of MuJoCo's renderer, with room for `geoms` of them.
class Scene3d {
 public:
  Scene3d(const mjModel& model, int geoms) {
    mjv_defaultScene(&scene);
    mjv_makeScene(&model, &scene, geoms);
  }
  ~Scene3d() { mjv_freeScene(&scene); }
  Scene3d(const Scene3d&) = delete;
  Scene3d& operator=(const Scene3d&) = delete;
  mjvScene scene;
};

/// Puts the skin's points, normals and colours where the renderer takes them from.
void set_skin(const Skin& skin, mjModel& model, mjrContext& context, mjvScene& scene) {
  const bool fits = model.nskin == 1 && model.ntex == 1 && model.nskinvert == skin.point.cols() &&
                    model.tex_width[0] == skin.rings();
  if (!fits) throw std::invalid_argument("the renderer was made for another skin");
  Eigen::Map<Eigen::Matrix3Xf>(scene.skinvert, 3, skin.point.cols()) = skin.point;
  Eigen::Map<Eigen::Matrix3Xf>(scene.skinnormal, 3, skin.normal.cols()) = skin.normal;
  mjtByte* pixel = model.tex_rgb;
  for (int row = 0; row < model.tex_height[0]; ++row) {
    for (const auto& colour : skin.colour) pixel = std::ranges::copy(colour, pixel).out;
  }
  mjr_uploadTexture(&model, &context, 0);
  mjvGeom& geom = scene.geoms[scene.ngeom++];
  const float white[] = {1, 1, 1, 1};
  mjv_initGeom(&geom, mjGEOM_SKIN, nullptr, nullptr, nullptr, white);
  geom.objtype = mjOBJ_SKIN;
  geom.objid = 0;
  geom.texid = 0;
  geom.texcoord = 1;
  geom.texrepeat[0] = geom.texrepeat[1] = 1;
  geom.specular = skin.specular;
  geom.shininess = 0.35f;
}

// Of a colour bar, px: its own size at most, the distance of its parts, and of letters above their
// line.
constexpr int bar_width = 340, bar_height = 16, bar_gap = 12, letter_height = 16;

/// Words that begin at (left, bottom), px; `align` of their width further left.
void draw_words(const std::string& words, int left, int bottom, double align, const View& view,
                const mjrContext& context) {
  int wide = 0;
  for (const char c : words) wide += context.charWidth[static_cast<unsigned char>(c)];
  const double x = std::max(0.0, left - align * wide);
  mjr_text(mjFONT_NORMAL, words.c_str(), &context, static_cast<float>(x / view.width),
           static_cast<float>(static_cast<double>(bottom) / view.height), 0, 0, 0);
}

/// After mjr_render() alone: words go by its window, which the colours change.
void draw_bar(const ColourBar& bar, const View& view, const mjrContext& context) {
  const int wide = std::min(bar_width, view.width * 2 / 5);  // beside the words of a film
  const int left = view.width - bar_gap - wide;
  const int bottom = bar_gap + letter_height + bar_gap / 2;
  const auto say = [&](const std::string& words, int at, int above, double align) {
    draw_words(words, at, above, align, view, context);
  };
  say(bar.least, left, bar_gap / 2, 0);
  say(bar.most, left + wide, bar_gap / 2, 1);
  say(bar.title, left + wide, bottom + bar_height + bar_gap / 2, 1);
  const auto count = static_cast<int>(bar.colour.size());
  for (int x = 0; x < wide; ++x) {
    const auto& c = bar.colour[static_cast<std::size_t>(x * count / wide)];
    mjr_rectangle({left + x, bottom, 1, bar_height}, c[0] / 255.0f, c[1] / 255.0f, c[2] / 255.0f,
                  1);
  }
}

/// Above the line of text in the lower left corner. After mjr_render() as draw_bar.
void draw_scale(const View& view, const mjrContext& context) {
  constexpr int bottom = bar_gap + 2 * letter_height, thick = 4;
  const double length = scale_bar(view);
  const int wide = static_cast<int>(std::lround(length * view.scale));
  mjr_rectangle({bar_gap, bottom, wide, thick}, 0, 0, 0, 1);
  draw_words(fmt::format("{:g} cm", length), bar_gap, bottom + thick + bar_gap / 2, 0, view,
             context);
}

}  // namespace

double scale_bar(const View& view) {
  const double most = view.width / 6.0 / view.scale;
  const double decade = std::pow(10, std::floor(std::log10(most)));
  return decade * (most >= 5 * decade ? 5 : most >= 2 * decade ? 2 : 1);
}

struct OffscreenRenderer::Parts {
  Parts(const mjModel& of, int width, int height, const PictureQuality& wanted)
      : quality(wanted), model(with_settings(of, width, height, wanted)) {
    mjr_defaultContext(&context);
    mjr_makeContext(model.get(), &context, mjFONTSCALE_150);
    mjr_setBuffer(mjFB_OFFSCREEN, &context);
  }
  ~Parts() { mjr_freeContext(&context); }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  PictureQuality quality;
  EglContext egl;
  ModelCopy model;
  mjrContext context;
};

OffscreenRenderer::OffscreenRenderer(const mjModel& model, int width, int height,
                                     const PictureQuality& quality)
    : parts_(std::make_unique<Parts>(model, width, height, quality)) {
  if (parts_->context.currentBuffer != mjFB_OFFSCREEN)
    fail("mjr_setBuffer", "no off-screen buffer");
}

OffscreenRenderer::~OffscreenRenderer() = default;

Image OffscreenRenderer::render(const std::vector<mjvGeom>& geoms, const View& view) {
  return draw(geoms, view, nullptr, "", nullptr);
}

Image OffscreenRenderer::render(const std::vector<mjvGeom>& geoms, const View& view,
                                const Skin& skin, const std::string& words, const ColourBar* bar) {
  return draw(geoms, view, &skin, words, bar);
}

Image OffscreenRenderer::draw(const std::vector<mjvGeom>& geoms, const View& view, const Skin* skin,
                              const std::string& words, const ColourBar* bar) {
  mjrContext& context = parts_->context;
  if (view.width > context.offWidth || view.height > context.offHeight) {
    throw std::runtime_error(
        fmt::format("picture of {} x {} px: the renderer can draw at most {} x {}", view.width,
                    view.height, context.offWidth, context.offHeight));
  }
  const double extent = parts_->model->stat.extent;
  const Vector3d middle = middle_of(geoms, view, skin);
  Scene3d holder(*parts_->model, static_cast<int>(geoms.size()) + 2);
  mjvScene& scene = holder.scene;
  scene.geoms[0] = backdrop(view, middle, extent);
  std::copy(geoms.begin(), geoms.end(), scene.geoms + 1);
  scene.ngeom = static_cast<int>(geoms.size()) + 1;
  if (skin != nullptr) set_skin(*skin, *parts_->model, context, scene);
  set_camera(scene, view, middle, extent);
  set_lights(scene, view, middle, lens * extent, parts_->quality.shadows);

  const mjrRect whole{0, 0, view.width, view.height};
  mjr_render(whole, &scene, &context);
  if (bar != nullptr) draw_bar(*bar, view, context);
  if (!words.empty()) {
    draw_scale(view, context);
    mjr_overlay(mjFONT_NORMAL, mjGRID_BOTTOMLEFT, whole, words.c_str(), nullptr, &context);
  }
  Image image{view.width, view.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(view.width) * view.height);
  mjr_readPixels(image.rgb.data(), nullptr, whole, &context);
  // OpenGL's rows come from the bottom.
  const std::ptrdiff_t row = 3 * static_cast<std::ptrdiff_t>(view.width);
  for (auto top = image.rgb.begin(), end = image.rgb.end(); end - top > row; top += row) {
    end -= row;
    std::swap_ranges(top, top + row, end);
  }
  return image;
}

void write_png(const Image& image, const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&png, file.c_str(), 0, image.rgb.data(), 0, nullptr) == 0) {
    throw FileError(fmt::format("{}: cannot be written: {}", file.string(), png.message));
  }
}

}  // namespace hagfish
