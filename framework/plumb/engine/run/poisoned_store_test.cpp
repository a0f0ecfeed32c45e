/// What lies in a store was perhaps written by somebody else, with a right checksum. It is made
/// again, or refused in words; it is never believed.
#include <gmock/gmock.h>

#include <fstream>
#include <limits>

#include "plumb/data/error.hpp"
#include "plumb/data/io/file_testing.hpp"
#include "plumb/engine/run/runner.hpp"
#include "plumb/engine/testing/test_steps.hpp"
#include "plumb/pipeline/reader.hpp"
#include "plumb/store/blob.hpp"
#include "plumb/store/blob_file.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using namespace toy;
using testing::AnyOf;
using testing::HasSubstr;

const std::string halving = "plumb: 1\nname: halving\nabout: a loop that halves\n" +
                            engine_test::halving_steps +
                            R"(  stitched: {use: test.stitch, from: merged}
  laid: {use: test.lay, from: {edges: edges, targets: stitched, sources: merged}}
  end: {use: test.halve, from: {matches: laid, poses: source.poses}}
  out: {use: test.write, from: {metrics: {loop: loop.solved.metrics, laid: end.metrics}}}
)";

struct PoisonedStore : testing::Test {
  io::TestFolder folder;
  Registry steps = engine_test::registry();
  std::string damage;  ///< what the last run said of the first damaged result
  std::size_t damaged = 0;

  std::string run(bool fresh = false) {
    const fs::path file = folder.write("halving.yaml", halving);
    const Plan plan = read_pipeline(file, {}, steps);
    Store store(folder.path() / "store");
    Observers silent;
    RunOptions options;
    options.threads = 2, options.store = &store, options.fresh = fresh;
    const std::string text =
        run_plan(plan, steps, options, silent).documents.at(0).document->bytes.text();
    damaged = store.damaged(), damage = store.damage();
    return text;
  }
  /// Changes all results of a step, with a checksum that fits; how many.
  template <class Change>
  std::size_t change(const std::string& step, Change apply) {
    std::size_t changed = 0;
    for_each_blob(folder.path() / "store", [&](const Hash128& key, const fs::path& file) {
      if (head_in(file, key)->step != step) return;
      StoredResult result = *read_blob(key, MappedFile(file).bytes());
      apply(result);
      EXPECT_TRUE(replace_whole(file, blob_of(key, result, step)));
      ++changed;
    });
    // Without what it remembers of the steps the next run opens their results.
    for (const char* file : {"index.sqlite", "index.sum"})
      fs::remove(folder.path() / "store" / file);
    return changed;
  }
  /// The changed results are said to be damaged for this reason and made again: the run's own are
  /// as before.
  template <class Change>
  void expect_made_again(const std::string& step, const std::string& why, Change apply) {
    const std::string before = run();
    EXPECT_EQ(damaged, 0u);
    const std::size_t changed = change(step, apply);
    ASSERT_GT(changed, 0u) << step;
    EXPECT_EQ(run(), before);
    EXPECT_EQ(damaged, changed) << step;
    EXPECT_THAT(damage, HasSubstr(why));
    run();
    EXPECT_EQ(damaged, 0u);
  }
};

template <class T, class Change>
void spoil(StoredResult& result, Change apply) {
  T value = *result.outputs.at(0).at(0).as<T>();
  apply(value);
  result.outputs[0][0] = any_value(std::move(value));
}

TEST_F(PoisonedStore, WithEdgesOfSegmentsThatThereAreNot) {
  expect_made_again("test.chain", "segments that there are not", [](StoredResult& r) {
    spoil<Edges>(r, [](Edges& e) { e.list.back().j = 1'000'000; });
  });
}

TEST_F(PoisonedStore, WithPointsOfFramesThatThereAreNot) {
  expect_made_again("test.merge", "frame that its segment does not have", [](StoredResult& r) {
    spoil<Segment>(r, [](Segment& s) { s.frame.at(0) = 60'000; });
  });
}

TEST_F(PoisonedStore, WithColumnsOfUnlikeLength) {
  expect_made_again("test.pair", "columns are not equally long",
                    [](StoredResult& r) { spoil<Matches>(r, [](Matches& m) { m.q.clear(); }); });
}

TEST_F(PoisonedStore, WithPosesThatAreNoNumbers) {
  expect_made_again("test.halve", "non-finite", [](StoredResult& r) {
    spoil<Poses>(r, [](Poses& p) { p.places.at(1) = std::numeric_limits<double>::infinity(); });
  });
}

TEST_F(PoisonedStore, WithValuesOfAnotherType) {
  expect_made_again("test.chain", "holds Poses where the step gives Edges",
                    [](StoredResult& r) { r.outputs[0][0] = any_value(Poses()); });
}

TEST_F(PoisonedStore, WithTooFewValuesOrOutputs) {
  expect_made_again("test.pair", "holds 0 values", [](StoredResult& r) { r.outputs[0].clear(); });
  expect_made_again("test.halve", "1 output where the step has 2",
                    [](StoredResult& r) { r.outputs.pop_back(); });
  expect_made_again("test.stitch", "3 values of its output 'groups' where the step gives 4",
                    [](StoredResult& r) { r.outputs[0].pop_back(); });
}

TEST_F(PoisonedStore, DoesNoHarmWhereNothingOfItIsOpened) {
  const std::string before = run();
  const fs::path index = folder.path() / "store" / "index.sqlite", kept = folder.path() / "kept";
  fs::copy_file(index, kept);
  fs::copy_file(folder.path() / "store" / "index.sum", folder.path() / "kept.sum");
  ASSERT_GT(change("test.chain", [](StoredResult& r) { r.outputs[0].clear(); }), 0u);
  fs::copy_file(kept, index);
  fs::copy_file(folder.path() / "kept.sum", folder.path() / "store" / "index.sum");
  EXPECT_EQ(run(), before);
  EXPECT_EQ(damaged, 0u);
}

TEST_F(PoisonedStore, WithAGraphOfMoreSegmentsThanThereAreIsRefused) {
  const std::string before = run();
  ASSERT_EQ(change("test.chain",
                   [](StoredResult& r) {
                     spoil<Edges>(r, [](Edges& e) { e.segments = 9, e.list.back() = {2, 8}; });
                   }),
            1u);
  const std::string said = io::refusal([&] { run(); });
  // By whichever is asked first of the two steps that take it.
  EXPECT_THAT(said, AnyOf(HasSubstr("step 'loop.pairs' (test.pair): 'segments' has 4 items"),
                          HasSubstr("step 'laid' (test.lay): 'targets' has 4 items")));
  EXPECT_THAT(said, HasSubstr("where the graph of the edges has 9"));
  EXPECT_THAT(said, HasSubstr("--refresh"));
  EXPECT_EQ(run(true), before);
}

}  // namespace
}  // namespace plumb
