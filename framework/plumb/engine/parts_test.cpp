#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>

#include "plumb/data/document.hpp"
#include "plumb/data/error.hpp"
#include "plumb/data/toy_testing.hpp"
#include "plumb/engine/cache/results.hpp"
#include "plumb/engine/record/output_folder.hpp"
#include "plumb/engine/run/parallel.hpp"

namespace plumb {
namespace {

namespace fs = std::filesystem;

TEST(Parallel, VisitsEachIndexOnceAlsoWhenNested) {
  std::vector<std::atomic<int>> visits(50 * 20);
  with_threads(2, [&] {
    parallel_for(
        50, [&](std::size_t i) { parallel_for(20, [&](std::size_t j) { ++visits[i * 20 + j]; }); });
  });
  for (const auto& v : visits) EXPECT_EQ(v, 1);
}

TEST(Parallel, RethrowsWhatABodyThrew) {
  const auto run = [] {
    parallel_for(100, [](std::size_t k) {
      if (k == 7) throw Error("seven");
    });
  };
  EXPECT_THROW(run(), Error);
}

TEST(Parallel, MakesTasksAsLongAsTheyAskForMore) {
  for (const unsigned threads : {1u, 2u, 8u}) {
    std::atomic<int> made = 0, looped = 0;
    with_threads(threads, [&] {
      run_tasks(3, [&]() -> std::size_t {
        parallel_for(10, [&](std::size_t) { ++looped; });
        return ++made <= 100 ? 2 : 0;
      });
    });
    EXPECT_EQ(made, 203);
    EXPECT_EQ(looped, 2030);
  }
  run_tasks(0, []() -> std::size_t { throw Error("there is none"); });
}

TEST(Parallel, MakesAsManyTasksAtATimeAsThereAreThreads) {
  std::atomic<int> inside = 0, most = 0;
  with_threads(2, [&] {
    run_tasks(50, [&]() -> std::size_t {
      const int now = ++inside;
      int before = most;
      while (now > before && !most.compare_exchange_weak(before, now)) {
      }
      parallel_for(20, [](std::size_t) {});
      --inside;
      return 0;
    });
  });
  EXPECT_LE(most, 2);
}

TEST(Results, ForgetsWhatWasNotUsedForLongest) {
  const auto value = [](std::size_t n) {
    StoredResult result;
    result.outputs.push_back({any_value(toy::Features{std::vector<float>(n)})});
    return result;
  };
  Results results(nullptr, false, 10'000);
  results.remember({0, 1}, value(1000));
  results.remember({0, 2}, value(1000));
  EXPECT_TRUE(results.find({0, 1}));
  results.remember({0, 3}, value(1000));  // 12,000 bytes: 2 goes, 1 was used later
  EXPECT_TRUE(results.find({0, 1}));
  EXPECT_FALSE(results.find({0, 2}));
  EXPECT_TRUE(results.find({0, 3}));
}

struct Folder : testing::Test {
  fs::path base = fs::temp_directory_path() / ("plumb_folder_" + std::to_string(getpid()));
  RunRecord record;
  Folder() { fs::create_directories(base); }
  ~Folder() override { fs::remove_all(base); }
  static RunResult with(const std::string& name, const std::string& bytes) {
    RunResult result;
    result.documents.push_back({"out", std::make_shared<const Document>(Document{name, bytes})});
    return result;
  }
  static std::string read(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(Folder, IsReplacedWhenItHoldsAnEarlierRun) {
  OutputFolder(base / "out").fill(record, with("a.txt", "one"));
  OutputFolder(base / "out").fill(record, with("b.txt", "two"));
  EXPECT_FALSE(fs::exists(base / "out/a.txt"));
  EXPECT_EQ(read(base / "out/b.txt"), "two");
  EXPECT_EQ(std::distance(fs::directory_iterator(base), {}), 1);  // nothing lies beside it
}

TEST_F(Folder, IsNotTouchedWhenItHoldsSomethingElse) {
  OutputFolder(base / "out").fill(record, with("a.txt", "one"));
  std::ofstream(base / "out/mine.txt") << "mine";
  EXPECT_THROW(OutputFolder(base / "out"), Error);
  EXPECT_EQ(read(base / "out/mine.txt"), "mine");
  EXPECT_EQ(read(base / "out/a.txt"), "one");
}

/// What an OutputFolder says to a folder in which a run left a.txt and something was done since.
struct Changed : Folder {
  std::string refused(const std::function<void(const fs::path& out)>& change) {
    fs::remove_all(base / "out");
    OutputFolder(base / "out").fill(record, with("a.txt", "one"));
    change(base / "out");
    try {
      OutputFolder folder(base / "out");
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(Changed, AFileOfTheRunThatWasEditedIsKept) {
  EXPECT_THAT(refused([](const fs::path& out) { std::ofstream(out / "a.txt") << "two"; }),
              testing::HasSubstr("'a.txt' was changed since a run wrote it"));
  EXPECT_EQ(read(base / "out/a.txt"), "two");
  EXPECT_THAT(
      refused([](const fs::path& out) { std::ofstream(out / "a.txt", std::ios::app) << "more"; }),
      testing::HasSubstr("'a.txt' was changed"));
  EXPECT_EQ(refused([](const fs::path& out) { std::ofstream(out / "a.txt") << "one"; }),
            "");  // the same bytes
  EXPECT_EQ(refused([](const fs::path& out) { fs::remove(out / "a.txt"); }), "");
}

TEST_F(Changed, AFolderLinkOrPipeUnderTheNameOfAFileIsKept) {
  const auto instead = [&](const std::function<void(const fs::path& file)>& make) {
    return refused([&](const fs::path& out) {
      fs::remove(out / "a.txt");
      make(out / "a.txt");
    });
  };
  EXPECT_THAT(instead([](const fs::path& file) {
                fs::create_directory(file), std::ofstream(file / "mine") << "mine";
              }),
              testing::HasSubstr("holds 'a.txt' that no run"));
  EXPECT_EQ(read(base / "out/a.txt/mine"), "mine");
  std::ofstream(base / "victim") << "one";
  EXPECT_THAT(instead([&](const fs::path& file) { fs::create_symlink(base / "victim", file); }),
              testing::HasSubstr("holds 'a.txt' that no run"));
  EXPECT_THAT(instead([](const fs::path& file) { mkfifo(file.c_str(), 0600); }),
              testing::HasSubstr("holds 'a.txt' that no run"));
  EXPECT_EQ(read(base / "victim"), "one");
}

TEST_F(Changed, AnEditedRecordProvesNothing) {
  const auto edited = [](const fs::path& out) {
    std::string text = read(out / lock_name);
    text.insert(text.find("steps:"),
                "  - thesis.tex: {bytes: 4, hash: " + hash_of("mine").text() + "}\n");
    std::ofstream(out / lock_name) << text;
    std::ofstream(out / "thesis.tex") << "mine";
  };
  EXPECT_THAT(refused(edited), testing::HasSubstr("run.lock.yaml was changed since"));
  EXPECT_EQ(read(base / "out/thesis.tex"), "mine");
  const auto of_an_earlier_plumb = [](const fs::path& out) {
    std::ofstream(out / lock_name) << "# A run of Plumb: what made the files beside this "
                                      "one.\nplumb: 0.1.0\nfiles:\n  - a.txt\n";
  };
  EXPECT_THAT(refused(of_an_earlier_plumb), testing::HasSubstr("or is of an earlier Plumb"));
}

TEST_F(Changed, ARecordThatNamesWhatLiesElsewhereReachesNothing) {
  std::ofstream(base / "thesis.tex") << "mine";
  RunRecord forged;
  forged.files = {{"../thesis.tex", 4, hash_of("mine")},
                  {(base / "thesis.tex").string(), 4, hash_of("mine")}};
  EXPECT_EQ(refused([&](const fs::path& out) {
              fs::remove(out / "a.txt");
              std::ofstream(out / lock_name) << lock_text(forged);
            }),
            "");
  OutputFolder(base / "out").fill(record, with("b.txt", "two"));
  EXPECT_EQ(read(base / "thesis.tex"), "mine");
}

TEST_F(Folder, LeavesNothingBehindWhenTheRunFails) {
  { const OutputFolder folder(base / "out"); }
  EXPECT_TRUE(fs::is_empty(base));
}

TEST_F(Folder, RefusesAPlaceThatCannotBeWritten) {
  std::ofstream(base / "file") << "x";
  EXPECT_THROW(OutputFolder(base / "file/out"), Error);
  EXPECT_THROW(OutputFolder(base / "file"), Error);
}

TEST_F(Folder, RefusesTwoFilesOfOneNameAndNamesThatLeaveTheFolder) {
  RunResult two = with("a.txt", "one");
  two.documents.push_back({"other", two.documents[0].document});
  EXPECT_THROW(OutputFolder(base / "out").fill(record, two), Error);
  EXPECT_THROW(OutputFolder(base / "out").fill(record, with("../a.txt", "")), Error);
  EXPECT_TRUE(fs::is_empty(base));
}

}  // namespace
}  // namespace plumb
