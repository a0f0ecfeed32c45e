#pragma once
/// For tests of what runs at the same time: steps that wait for each other, fail, count and warn.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "plumb/engine/testing/test_steps.hpp"

namespace plumb::engine_test {

/// Who has come, in the order in which they did.
class Meeting {
 public:
  void begin() {
    const std::lock_guard lock(mutex_);
    names_.clear();
  }
  void come(const std::string& name) {
    {
      const std::lock_guard lock(mutex_);
      names_.push_back(name);
    }
    changed_.notify_all();
  }
  /// Whether `name` comes so often before long.
  bool wait_for(const std::string& name, std::size_t times) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(30), [&] { return seen(name) >= times; });
  }
  std::size_t count(const std::string& name) {
    const std::lock_guard lock(mutex_);
    return seen(name);
  }
  std::vector<std::string> names() {
    const std::lock_guard lock(mutex_);
    return names_;
  }

 private:
  std::size_t seen(const std::string& name) const {
    return static_cast<std::size_t>(std::count(names_.begin(), names_.end(), name));
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> names_;
};
inline Meeting meeting;

inline constexpr const char* nobody = "nobody";

/// Comes, waits for another step, and halves all distances.
struct Meet : WholeStep {
  struct In {
    One<Poses> poses;
  };
  struct Params {
    std::string name = "somebody", other = nobody;
    int times = 1;
    bool fail = false;
  };
  struct Out {
    Poses poses;
    Metrics metrics;
  };
  static void describe(Declaration<Meet>& is) {
    is.name("test.meet").version(1).summary("Waits for another step.").source("");
    is.param("name", &Params::name).doc("who comes");
    is.param("other", &Params::other).doc("who is waited for");
    is.param("times", &Params::times).range(1, 1000).doc("how often that one must have come");
    is.param("fail", &Params::fail).doc("fail then");
    is.input("poses", &In::poses, "");
    is.output("poses", &Out::poses, "").output("metrics", &Out::metrics, "");
  }
  Out run(const In& in, const Params& params, Context&) const {
    meeting.come(params.name);
    const bool met = params.other == nobody ||
                     meeting.wait_for(params.other, static_cast<std::size_t>(params.times));
    if (params.fail) {
      meeting.come("failure");
      throw Error("has had enough");
    }
    Out out{*in.poses, {}};
    for (double& place : out.poses.places) place *= 0.5;
    out.metrics.add("met", met ? 1 : 0, "");
    return out;
  }
};

/// Of a segment its first frame, and the last pose's place if there are poses. It tells of itself:
/// counts, and warns of every second segment.
struct Tell : SegmentStep {
  struct In {
    One<FrameRange> range;
    One<Poses> poses;
  };
  struct Params {
    std::string name = "somebody", other = nobody;
    int together = 1, times = 1;
  };
  struct Out {
    Features features;
  };
  static void describe(Declaration<Tell>& is) {
    is.name("test.tell").version(1).summary("Tells of itself.").source("");
    is.param("name", &Params::name).doc("who comes with each segment");
    is.param("other", &Params::other).doc("who is waited for, a moment longer than it takes");
    is.param("together", &Params::together)
        .range(1, 1000)
        .doc("so many segments come, or it fails");
    is.param("times", &Params::times).range(1, 1000).doc("by how much");
    is.input("range", &In::range, "").optional_input("poses", &In::poses, "");
    is.output("features", &Out::features, "");
  }
  Out run(const In& in, const Params& params, Context& context) const {
    meeting.come(params.name);
    if (!meeting.wait_for(params.name, static_cast<std::size_t>(params.together)))
      throw Error("is alone");
    if (params.other != nobody && meeting.wait_for(params.other, 1))
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    context.count("segments told of", 1);
    const auto first = static_cast<float>(in.range->first);
    if (in.range->first % 2 == 0) context.warn("frame " + std::to_string(in.range->first));
    const float place = in.poses ? static_cast<float>(in.poses->places.back()) : 0;
    return {Features{{first * static_cast<float>(params.times), place}}};
  }
};

/// Sums all features, in order, and halves all distances.
struct Gauge : WholeStep {
  struct In {
    Each<Features> features;
    One<Poses> poses;
  };
  struct Params {
    std::string name = "somebody";
  };
  struct Out {
    Poses poses;
    Metrics metrics;
  };
  static void describe(Declaration<Gauge>& is) {
    is.name("test.gauge").version(1).summary("Sums.").source("");
    is.param("name", &Params::name).doc("who comes");
    is.input("features", &In::features, "").input("poses", &In::poses, "");
    is.output("poses", &Out::poses, "").output("metrics", &Out::metrics, "");
  }
  Out run(const In& in, const Params& params, Context& context) const {
    meeting.come(params.name);
    context.count("collections summed", 1);
    Out out{*in.poses, {}};
    for (double& place : out.poses.places) place *= 0.5;
    double sum = 0;
    for (std::size_t k = 0; k < in.features.size(); ++k)
      for (const float value : in.features.open(k)->values) sum = sum / 2 + value;
    out.metrics.add("sum", sum, "");
    return out;
  }
};

inline Registry meeting_registry() {
  static const StepOf<Meet> meet;
  static const StepOf<Tell> tell;
  static const StepOf<Gauge> gauge;
  Registry steps = registry();
  for (const Step* step : std::initializer_list<const Step*>{&meet, &tell, &gauge})
    steps.add(*step);
  return steps;
}

}  // namespace plumb::engine_test
