/// plumb migrate: the text of an old pipeline by the names of now, and nothing else of it changed.
#include "plumb/pipeline/migrate.hpp"

#include <gmock/gmock.h>

#include "plumb/pipeline/testing/former_testing.hpp"

namespace plumb {
namespace {

using test::cascade_of_now;
using test::old_cascade;
using testing::HasSubstr;
using testing::IsEmpty;

class Migrate : public testing::Test {
 protected:
  Migrated migrate(const std::string& name, const std::string& text) const {
    return migrated(folder_.write(name, text), test::registry(), test::former());
  }
  /// The text after it; running it again changes nothing.
  std::string rewritten(const std::string& text, const std::string& name = "a.yaml") const {
    const Migrated first = migrate(name, text);
    EXPECT_THAT(first.done, testing::Not(IsEmpty()));
    const Migrated second = migrate(name, first.text);
    EXPECT_THAT(second.done, IsEmpty());
    EXPECT_EQ(second.text, first.text);
    return first.text;
  }
  std::string told(const std::string& text, const std::string& name = "a.yaml") const {
    return io::refusal([&] { migrate(name, text); });
  }
  test::Folder folder_;
};

TEST_F(Migrate, EachKindOfNameInFlowMaps) {
  EXPECT_EQ(rewritten(old_cascade()), cascade_of_now());
  EXPECT_EQ(migrate("now.yaml", cascade_of_now()).text, cascade_of_now());
  EXPECT_THAT(migrate("now.yaml", cascade_of_now()).done, IsEmpty());
}

/// The cascade with a step in block style in the place of `fpfh` and of `kept`.
std::string in_blocks(const std::string& fpfh, const std::string& kept) {
  return test::exchanged(test::cascade,
                         {{"  fpfh:     {use: describe.fpfh, from: segments}\n", fpfh},
                          {"      kept:   {use: prune.kmeans, from: {matches: near, poses: "
                           "poses}}\n",
                           kept}});
}

TEST_F(Migrate, BlockMapsWithTheirCommentsAndLayout) {
  const std::string was = in_blocks(
      "  fpfh:   # of 'clouds'\n"
      "    use:    'describe.points'   # was: describe.points\n"
      "    # nothing is given\n"
      "    from:   segments\n",
      "      kept:\n"
      "        from: {matches: near, poses: poses}\n"
      "        use: prune.kmeans\n");
  const std::string now = in_blocks(
      "  fpfh:   # of 'clouds'\n"
      "    use:    'describe.fpfh'   # was: describe.points\n"
      "    with: {angle: 0.26 rad}\n"
      "    # nothing is given\n"
      "    from:   segments\n",
      "      kept:\n"
      "        from: {matches: near, poses: poses}\n"
      "        use: prune.kmeans\n"
      "        with: {clusters: 5}\n");
  EXPECT_EQ(rewritten(was), now);
  const auto windows = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 2)
      text.insert(at, "\r");
    return text;
  };
  EXPECT_EQ(rewritten(windows(was)), windows(now));
  EXPECT_EQ(rewritten(in_blocks("  fpfh:\n"
                                "    use: describe.points\n"
                                "    with:\n"
                                "      # how far\n"
                                "      radius: 2 m  # far\n"
                                "    from: segments\n",
                                "      kept: {use: prune.kmeans, from: {matches: near, poses: "
                                "poses}, with: { }}\n")),
            in_blocks("  fpfh:\n"
                      "    use: describe.fpfh\n"
                      "    with:\n"
                      "      # how far\n"
                      "      angle: 0.26 rad\n"
                      "      radius: 2 m  # far\n"
                      "    from: segments\n",
                      "      kept: {use: prune.kmeans, from: {matches: near, poses: poses}, with: "
                      "{clusters: 5 }}\n"));
}

TEST_F(Migrate, PresetsByWhatTheyExtendAndServe) {
  folder_.write("cascade.yaml", old_cascade());
  folder_.write("other.yaml", test::exchanged(cascade_of_now(), {{"name: cascade", "name: o"}}));
  const auto preset = [](const std::vector<const char*>& words) {
    std::string text = R"(# A preset.
plumb: 1
extends: ../cascade.yaml
set:
  @: 7            # fewer
  "@": [3 m, 1 m]
remove: [@, drift]
replace: {edges: {use: @, from: {@: segments, poses: @}}}
also:
  ../other.yaml:
    set: {@: 1 m}
)";
    for (const char* word : words) text.replace(text.find('@'), 1, word);
    return test::exchanged(text, {{", drift]", "]"}});
  };
  EXPECT_EQ(rewritten(preset({"ranges.length", "coarse.reach", "segments.grid", "edges.near",
                              "clouds", "ranges.start", "segments.grid"}),
                      "presets/p.yaml"),
            preset({"ranges.frames", "coarse.gate", "segments.leaf", "edges.overlap", "segments",
                    "ranges.poses", "segments.leaf"}));
}

TEST_F(Migrate, TellsWhatItCannotRewriteAndChangesNothing) {
  const std::string aliased = test::exchanged(
      cascade_of_now(), {{"voxel: {type: length, default: 0.3 m, about: leaf}",
                          "voxel: {type: length, default: 0.3 m, about: &word leaf}"},
                         {"poses: ranges.poses", "poses: &start ranges.start"},
                         {"poses: drift.solved}}", "poses: *start}}"}});
  EXPECT_THAT(told(aliased), HasSubstr("a.yaml:19:65: 'ranges.poses' for 'ranges.start' cannot be "
                                       "written here, behind an alias."));
  EXPECT_THAT(told(aliased), HasSubstr("Write out here what the alias stands for"));
  EXPECT_THAT(told(test::exchanged(cascade_of_now(),
                                   {{"poses: ranges.poses", "poses: \"ranges.\\x73tart\""}})),
              HasSubstr("cannot be written here; write it yourself."));
  const std::string anchored =
      test::exchanged(cascade_of_now(), {{"poses: ranges.poses", "poses: &start ranges.start"}});
  EXPECT_EQ(rewritten(anchored), test::exchanged(anchored, {{"ranges.start", "ranges.poses"}}));
  EXPECT_THAT(told(test::exchanged(old_cascade(), {{"from: sequence}", "from: sequense}"}})),
              HasSubstr("Did you mean 'sequence'?"));
  EXPECT_THAT(told("# A run of Plumb: what made the files beside this one.\n"),
              HasSubstr("the record of a run, not a pipeline"));
}

TEST_F(Migrate, SaysWhatItDid) {
  const Migrated result = migrate("a.yaml", old_cascade());
  const std::string file = (folder_.path() / "a.yaml").string();
  EXPECT_EQ(result.done.front().done(), file + ":9:71: 'length' is 'frames' now");
  EXPECT_EQ(result.done[3].done(),
            file + ":13:3: 'angle: 0.26 rad', the former default, is written out");
}

}  // namespace
}  // namespace plumb
