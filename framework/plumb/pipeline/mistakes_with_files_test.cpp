/// Files that are not there or are no pipeline; and texts that nobody would write.
#include <gmock/gmock.h>

#include "plumb/pipeline/testing/mistakes_testing.hpp"

namespace plumb {
namespace {

using test::cascade;
using test::told;
using test::with;
using testing::HasSubstr;

TEST(Mistakes, OfNamingFilesThatAreNotThere) {
  const test::Folder folder;
  folder.write("street/odometry.tum", "");
  const std::string place = folder.path().string();
  const auto told_for = [&](const std::string& value, bool in_file, bool needs_files = true) {
    Overlay overlay;
    overlay.needs_files = needs_files;
    if (!in_file) overlay.sets = {"input=" + value};
    const std::string given = in_file ? "{type: path, default: " + value : "{type: path";
    try {
      read_pipeline(folder.write("a.yaml", with("{type: path", given)), overlay, test::registry());
    } catch (const PipelineError& error) {
      EXPECT_EQ(error.diagnostics().size(), 1u);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(told_for("street", true), "");
  EXPECT_EQ(told_for(place + "/street", false), "");
  EXPECT_EQ(told_for("nowhere", true, false), "");  // what only looks at the wires needs no data
  const std::string in_file = told_for("stret", true);
  EXPECT_THAT(in_file,
              HasSubstr("a.yaml:5:32: step 'sequence' (source.sequence): parameter 'path': "
                        "there is no file or folder '" +
                        place + "/stret'."));
  EXPECT_THAT(in_file, HasSubstr("Did you mean '" + place + "/street'?"));
  const std::string in_set = told_for(place + "/far/away", false);
  EXPECT_THAT(in_set, HasSubstr("--set input=" + place + "/far/away: step 'sequence'"));
  EXPECT_THAT(in_set, HasSubstr("There is no folder '" + place + "/far' either."));
  EXPECT_THAT(in_set, HasSubstr("Asked for at " + place + "/a.yaml:8:3."));
}

TEST(Mistakes, OfNamingAStepThatTheBuildLeftOut) {
  namespace fs = std::filesystem;
  const test::Folder folder;
  const fs::path modules = folder.path() / "modules";
  const fs::path file = folder.write("modules/left_out.txt",
                                     "describe.vfh: PCL was not found; install libpcl-dev and "
                                     "build again\n");
  fs::permissions(modules, static_cast<fs::perms>(0755));
  fs::permissions(file, static_cast<fs::perms>(0644));
  Registry registry = Registry::scan({modules});
  test::add_cloud_steps(registry);
  test::add_graph_steps(registry);
  const fs::path pipeline = folder.write("a.yaml", with("use: describe.fpfh", "use: describe.vfh"));
  try {
    read_pipeline(pipeline, {{}, {"input=data"}, false}, registry);
    FAIL();
  } catch (const PipelineError& error) {
    EXPECT_EQ(error.diagnostics().size(), 1u);
    EXPECT_THAT(error.what(),
                HasSubstr("a.yaml:13:19: step 'fpfh': 'describe.vfh' is not in this build: PCL "
                          "was not found; install libpcl-dev and build again.\n"));
  }
}

TEST(Mistakes, OfFilesThatAreNotThere) {
  try {
    read_pipeline("no/such.yaml", {}, test::registry());
    FAIL();
  } catch (const PipelineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("there is no file 'no/such.yaml'."));
  }
}

TEST(Mistakes, OfTakingSomethingElseForAPipeline) {
  EXPECT_THAT(told("# .PCD v0.7\nVERSION 0.7\n"),
              HasSubstr("a.yaml' is a point cloud (PCD), not a pipeline."));
  EXPECT_THAT(told("{\n  \"$schema\": \"x\"}"),
              HasSubstr("a.yaml' is a JSON Schema, not a pipeline."));
  EXPECT_THAT(told("# A run of Plumb: what made the files beside this one.\nplumb: 0.1\n"),
              HasSubstr("a.yaml' is the record of a run, not a pipeline."));
  EXPECT_THAT(told("# which?\nexperiment: 1\npipeline: city.yaml\n"),
              HasSubstr("a.yaml' is an experiment, not a pipeline.\n  Run it: plumb compare "));
  EXPECT_THAT(told("plumb: 1\npipeline: city.yaml\nprimary: error.ate\n"),
              HasSubstr("a.yaml' is an experiment, not a pipeline.\n"));
  EXPECT_THAT(told("1 2 3 4 0 0 0 1\n"),
              HasSubstr("is a trajectory (TUM), not a pipeline.\n  Give the YAML file"));
  const test::Folder folder;
  folder.write("pipelines/city.yaml", cascade);
  const auto told_of = [&](const std::string& name) {
    try {
      read_pipeline(folder.path() / name, {}, test::registry());
    } catch (const PipelineError& error) {
      EXPECT_EQ(error.diagnostics().size(), 1u);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(told_of("pipelines"),
              HasSubstr("pipelines' is a folder, not a pipeline.\n  In it: "));
  folder.write("street/scene.yaml", "path: city_loop\nframes: 200\n");
  folder.write("street/odometry.tum", "");
  EXPECT_THAT(told_of("street"),
              HasSubstr("street' is a folder, not a pipeline.\n  Give the YAML file of a pipeline; "
                        "its data goes behind --set, as in --set input="));
  EXPECT_THAT(told_of("pipelines/ctiy.yaml"),
              HasSubstr("Did you mean '" + (folder.path() / "pipelines/city.yaml").string()));
  EXPECT_THAT(told_of("pipelines/city"), HasSubstr("/pipelines/city.yaml'?"));
}

TEST(Mistakes, NeverCrashTheReader) {
  const test::Folder folder;
  std::uint64_t state = 1;
  const auto random = [&](std::size_t n) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>((state >> 33) % n);
  };
  const auto survives = [&](const std::string& text) {
    try {
      read_pipeline(folder.write("f.yaml", text), {{}, {"input=data"}, false}, test::registry());
    } catch (const PipelineError& error) {
      EXPECT_FALSE(error.diagnostics().empty());
    }
  };
  for (std::size_t length = 0; length < cascade.size(); length += 23)
    survives(cascade.substr(0, length));
  for (int k = 0; k < 200; ++k) {
    std::string text = cascade;
    for (std::size_t flips = 1 + random(3); flips > 0; --flips)
      text[random(text.size())] = static_cast<char>(random(256));
    survives(text);
  }
  for (int k = 0; k < 100; ++k) {  // pieces moved elsewhere
    std::string text = cascade;
    const std::string piece = text.substr(random(text.size()), 1 + random(60));
    survives(text.insert(random(text.size()), piece));
  }
}

}  // namespace
}  // namespace plumb
