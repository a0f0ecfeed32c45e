/// plumb_bench: each kernel beside its twin, on one thread, in one run. `--small` first makes a
/// scene for trying that all of them run; everything else is Google Benchmark's.

#include <benchmark/benchmark.h>

#include <cstring>

#include "scene.hpp"

int main(int count, char** words) {
  if (count > 1 && std::strcmp(words[1], "--small") == 0) {
    plumb::bench::make_scene_small();
    words[1] = words[0];
    ++words, --count;
  }
  benchmark::Initialize(&count, words);
  if (benchmark::ReportUnrecognizedArguments(count, words)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
