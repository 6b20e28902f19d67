// The digest of q at every frame of a built-in scene, as the page gives it (simulator.js), by this
// build of the simulator: digest SCENE [KEY=VALUE]... [--q FILE].
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "core/input/builtin_files.hpp"
#include "core/input/scene_text.hpp"
#include "experiments/live/live_run.hpp"

namespace {

struct Digest {
  std::uint32_t a = 2166136261, b = 374761393;

  void add(const std::vector<double>& values) {
    for (const double value : values) {
      const auto bits = std::bit_cast<std::uint64_t>(value);
      for (const std::uint64_t half : {bits & 0xffffffff, bits >> 32}) {
        const auto word = static_cast<std::uint32_t>(half);
        a = (a ^ word) * 16777619U;
        b = std::rotl((b ^ word) * 2246822519U, 13);
      }
    }
  }
};

}  // namespace

int main(int argc, char** argv) {
  using namespace hagfish;
  try {
    std::vector<std::string> words(argv + 1, argv + argc);
    std::ofstream states;
    if (words.size() > 2 && words[words.size() - 2] == "--q") {
      states.open(words.back(), std::ios::binary);
      words.resize(words.size() - 2);
    }
    const std::string name = words.at(0);
    const auto text = builtin_file(name + ".toml");
    if (!text) throw std::invalid_argument("no such scene: " + name);
    LiveRun run(read_scene_source({std::string(*text), name, std::nullopt},
                                  {words.begin() + 1, words.end()}));
    const TimeSettings& clock = run.resolved().scene.time;
    const int steps = static_cast<int>(std::lround(clock.frame_interval / clock.step));
    const std::clock_t begin = std::clock();
    Digest digest;
    int frames = 0;
    double time = 0;
    for (bool more = true; more; more = run.advance(steps) == steps) {
      const auto frame = run.frame();
      const std::vector<double>& q = frame[1].values;
      digest.add(q);
      states.write(reinterpret_cast<const char*>(q.data()),
                   static_cast<std::streamsize>(q.size() * sizeof(double)));
      time = frame[0].values[0];
      ++frames;
    }
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    std::printf("%s: %08x%08x of %d frames, %.2f s in %.2f s of the processor, %.1f x real time\n",
                name.c_str(), digest.a, digest.b, frames, time, seconds, time / seconds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
