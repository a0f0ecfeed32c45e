/// As many items as asked for, and a step that does nothing with each: what an item costs beside
/// its work.
#include "plumb/slam/step.hpp"

#include "plumb/data/document.hpp"
#include "plumb/plugin/module.hpp"

namespace plumb {
namespace {

struct Items : WholeStep {
  struct In {};
  struct Out {
    std::vector<FrameRange> ranges;
  };
  struct Params {
    int items = 2000;
  };
  static void describe(Declaration<Items>& is) {
    is.name("test.items").version(1).summary("Gives ranges.");
    is.param("items", &Params::items).range(1, 1e6).doc("how many");
    is.output("ranges", &Out::ranges, "ranges of one frame");
  }
  Out run(const In&, const Params& params, Context&) const {
    Out out;
    for (int k = 0; k < params.items; ++k) {
      FrameRange range;
      range.first = static_cast<std::uint32_t>(k);
      range.end = range.first + 1;
      range.T_segment_frame.resize(1);
      out.ranges.push_back(range);
    }
    return out;
  }
};

struct Nothing : SegmentStep {
  struct In {
    One<FrameRange> range;
  };
  struct Out {
    Descriptor descriptor;
  };
  struct Params {
    int round = 0;
  };
  static void describe(Declaration<Nothing>& is) {
    is.name("test.nothing").version(1).summary("Does nothing.");
    is.param("round", &Params::round).doc("another number is another result");
    is.input("range", &In::range, "a range").output("descriptor", &Out::descriptor, "empty");
  }
  Out run(const In&, const Params&, Context&) const { return {}; }
};

struct Count : WholeStep {
  struct In {
    Each<Descriptor> descriptors;
  };
  struct Out {
    Document document;
  };
  struct Params {};
  static void describe(Declaration<Count>& is) {
    is.name("test.count").version(1).summary("Counts.");
    is.input("descriptors", &In::descriptors, "to count")
        .output("document", &Out::document, "their number");
  }
  Out run(const In& in, const Params&, Context&) const {
    return {{"count.txt", std::to_string(in.descriptors.size()) + "\n"}};
  }
};

}  // namespace
}  // namespace plumb

PLUMB_MODULE(plumb::Items, plumb::Nothing, plumb::Count)
