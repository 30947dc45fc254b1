#include "globebrowsing/network/disk_cache.h"

#include <csignal>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "globebrowsing/network/cache_worker.h"
#include "network_fixture.h"

namespace meridian::globebrowsing {
namespace {

namespace fs = std::filesystem;

CachedAnswer answerOf(std::size_t bytes, char letter = 'x') {
  return {{HeaderFields::fromText("ETag: \"1\"\nContent-Type: image/png\nX-Dropped: 1"), 10, 11},
          std::make_shared<const std::vector<std::uint8_t>>(bytes, static_cast<std::uint8_t>(letter))};
}

class DiskCacheTest : public testing::Test {
 protected:
  DiskCacheTest() { options.folder = folder.path(); }
  [[nodiscard]] fs::path file() const { return DiskCache::fileIn(folder.path()); }
  /// The number of "http:...: the cache of downloads" lines in the log.
  static std::size_t complaints(const std::string& log) {
    std::size_t count = 0;
    for (std::size_t at = log.find("the cache of downloads"); at != std::string::npos;
         at = log.find("the cache of downloads", at + 1)) {
      ++count;
    }
    return count;
  }
  void fill(int count, std::size_t bytes = 100) {
    DiskCache cache(options, statistics);
    for (int i = 0; i < count; ++i) {
      cache.store(std::to_string(i), answerOf(bytes));
    }
  }

  TestFolder folder;
  CacheOptions options;
  NetworkStatistics statistics;
};

TEST_F(DiskCacheTest, GivesBackWhatItWasGiven) {
  {
    DiskCache cache(options, statistics);
    EXPECT_FALSE(cache.find("a"));
    cache.store("a", answerOf(1000, 'a'));
    cache.store("b", answerOf(0));
    cache.store("a", answerOf(2000, 'c'));
  }
  DiskCache cache(options, statistics);
  const auto a = cache.find("a");
  ASSERT_TRUE(a);
  EXPECT_EQ(*a->body, *answerOf(2000, 'c').body);
  EXPECT_EQ(a->facts.fields.text(), "ETag: \"1\"\nContent-Type: image/png\n");
  EXPECT_EQ(a->facts.requestTime, 10);
  EXPECT_EQ(a->facts.responseTime, 11);
  ASSERT_TRUE(cache.find("b"));
  EXPECT_TRUE(cache.find("b")->body->empty());
  cache.refresh("a", {HeaderFields::fromText("ETag: \"2\""), 20, 21});
  EXPECT_EQ(cache.find("a")->facts.responseTime, 21);
  EXPECT_EQ(cache.find("a")->body->size(), 2000U);
  cache.remove("a");
  cache.remove("never there");
  EXPECT_FALSE(cache.find("a"));
}

TEST_F(DiskCacheTest, StaysWithinItsBudgetAndDropsWhatWasNotUsedForLongest) {
  options.maximumBytes = 1'000'000;
  DiskCache cache(options, statistics);
  cache.store("first", answerOf(10'000));
  for (int i = 0; i < 300; ++i) {
    cache.store(std::to_string(i), answerOf(10'000));
    ASSERT_TRUE(cache.find("first")) << i;
  }
  cache.commit();
  EXPECT_LE(statistics.cacheBytes, options.maximumBytes);
  EXPECT_GT(statistics.cacheBytes, options.maximumBytes / 2);
  EXPECT_GT(statistics.evicted, 150U);
  EXPECT_FALSE(cache.find("0"));
  EXPECT_TRUE(cache.find("299"));
  EXPECT_LT(fs::file_size(file()), 2 * options.maximumBytes);

  cache.store("huge", answerOf(300'000));
  EXPECT_FALSE(cache.find("huge")) << "nothing takes a quarter of the budget";
  cache.setMaximumBytes(50'000);
  EXPECT_LE(statistics.cacheBytes, 50'000U);
  EXPECT_TRUE(cache.find("first"));
}

TEST_F(DiskCacheTest, TheFileShrinksWithItsBudget) {
  options.maximumBytes = 8'000'000;
  fill(400, 10'000);
  EXPECT_GT(fs::file_size(file()), 4'000'000U);
  options.maximumBytes = 100'000;
  EXPECT_FALSE(DiskCache(options, statistics).find("0"));
  EXPECT_LT(fs::file_size(file()), 400'000U);
}

TEST_F(DiskCacheTest, ModesSayWhatIsReadAndWritten) {
  fill(1);
  for (const CacheMode mode : {CacheMode::ReadOnly, CacheMode::CacheOnly}) {
    options.mode = mode;
    DiskCache cache(options, statistics);
    EXPECT_TRUE(cache.find("0"));
    cache.store("new", answerOf(10));
    cache.remove("0");
    EXPECT_FALSE(cache.find("new"));
    EXPECT_TRUE(cache.find("0"));
  }
  options.mode = CacheMode::Off;
  DiskCache cache(options, statistics);
  EXPECT_FALSE(cache.find("0"));
  cache.setMode(CacheMode::ReadWrite);
  EXPECT_TRUE(cache.find("0"));
}

TEST_F(DiskCacheTest, ReadingWhatIsNotThereMakesNothing) {
  options.mode = CacheMode::ReadOnly;
  options.folder = folder.path() / "none";
  testing::internal::CaptureStderr();
  DiskCache cache(options, statistics);
  EXPECT_FALSE(cache.find("0"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_FALSE(fs::exists(options.folder));
}

TEST_F(DiskCacheTest, OneThatIsNoDatabaseIsSetAsideAndMadeAnew) {
  std::ofstream(file()) << std::string(100'000, 'q');
  testing::internal::CaptureStderr();
  {
    DiskCache cache(options, statistics);
    EXPECT_FALSE(cache.find("a"));
    cache.store("a", answerOf(10));
    EXPECT_TRUE(cache.find("a"));
  }
  EXPECT_EQ(complaints(testing::internal::GetCapturedStderr()), 1U);
  EXPECT_TRUE(fs::exists(file().string() + ".damaged"));
  EXPECT_TRUE(DiskCache(options, statistics).find("a"));
}

TEST_F(DiskCacheTest, DamageFoundWhileItIsUsedIsNoBodysProblem) {
  fill(500, 3000);
  {
    std::fstream damaged(file(), std::ios::in | std::ios::out | std::ios::binary);
    damaged.seekp(4096);
    damaged << std::string(fs::file_size(file()) - 8192, '\xA7');
  }
  testing::internal::CaptureStderr();
  DiskCache cache(options, statistics);
  for (int i = 0; i < 500; ++i) {
    static_cast<void>(cache.find(std::to_string(i)));
    cache.store(std::to_string(i), answerOf(10));
    ASSERT_TRUE(cache.find(std::to_string(i))) << i;
  }
  EXPECT_EQ(complaints(testing::internal::GetCapturedStderr()), 1U);
}

TEST_F(DiskCacheTest, DamagedAndOnlyReadIsLeftAlone) {
  std::ofstream(file()) << std::string(100'000, 'q');
  options.mode = CacheMode::ReadOnly;
  testing::internal::CaptureStderr();
  DiskCache cache(options, statistics);
  EXPECT_FALSE(cache.find("a"));
  EXPECT_FALSE(cache.find("b"));
  EXPECT_EQ(complaints(testing::internal::GetCapturedStderr()), 1U);
  EXPECT_EQ(fs::file_size(file()), 100'000U);
}

TEST_F(DiskCacheTest, AFolderThatCannotBeMadeMeansNoCache) {
  std::ofstream(folder.path() / "file") << "in the way";
  options.folder = folder.path() / "file" / "cache";
  testing::internal::CaptureStderr();
  DiskCache cache(options, statistics);
  cache.store("a", answerOf(10));
  EXPECT_FALSE(cache.find("a"));
  EXPECT_FALSE(cache.find("b"));
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(complaints(log), 1U) << log;
  EXPECT_THAT(log, testing::HasSubstr("name another one"));
}

/// A folder that nobody may write to still serves. Root may write everywhere, so root becomes somebody else.
TEST_F(DiskCacheTest, OneThatCannotBeWrittenIsRead) {
  fill(3);
  fs::permissions(file(), fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec | fs::perms::group_read |
                                     fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec);
  const bool isRoot = geteuid() == 0;
  if (isRoot) {
    ASSERT_EQ(seteuid(65534), 0);
  }
  testing::internal::CaptureStderr();
  {
    DiskCache cache(options, statistics);
    EXPECT_TRUE(cache.find("0"));
    cache.store("new", answerOf(10));
    EXPECT_TRUE(cache.find("1"));
    EXPECT_FALSE(cache.find("new"));
  }
  const std::string log = testing::internal::GetCapturedStderr();
  if (isRoot) {
    ASSERT_EQ(seteuid(0), 0);
  }
  fs::permissions(folder.path(), fs::perms::owner_all);
  EXPECT_EQ(complaints(log), 1U) << log;
  EXPECT_THAT(log, testing::HasSubstr("only read from now on"));
}

/// The disk is full: the process may write no file larger than some bytes, which SQLite meets as a failed write.
TEST_F(DiskCacheTest, AFullDiskEndsWritingAndNotReading) {
  fill(3);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{400'000, before.rlim_max};
  testing::internal::CaptureStderr();
  std::size_t found = 0;
  {
    DiskCache cache(options, statistics);
    EXPECT_TRUE(cache.find("0"));
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    for (int i = 100; i < 200; ++i) {
      cache.store(std::to_string(i), answerOf(10'000));
      cache.commit();
    }
    found = cache.find("0") && cache.find("1") && cache.find("2") ? 3 : 0;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  }
  const std::string log = testing::internal::GetCapturedStderr();
  std::signal(SIGXFSZ, SIG_DFL);
  EXPECT_EQ(found, 3U);
  EXPECT_EQ(complaints(log), 1U) << log;
  EXPECT_TRUE(DiskCache(options, statistics).find("2"));
}

TEST_F(DiskCacheTest, OneThatAnotherProgramHoldsIsNotWaitedForTwice) {
  fill(1);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(file().c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  testing::internal::CaptureStderr();
  {
    DiskCache cache(options, statistics);
    for (int i = 0; i < 100; ++i) {
      cache.store("new " + std::to_string(i), answerOf(10));
      EXPECT_TRUE(cache.find("0"));
    }
  }
  const std::string log = testing::internal::GetCapturedStderr();
  sqlite3_close(other);
  EXPECT_EQ(complaints(log), 1U) << log;
  EXPECT_THAT(log, testing::HasSubstr("another program holds it"));
}

TEST_F(DiskCacheTest, TwoProgramsShareOne) {
  DiskCache one(options, statistics);
  DiskCache other(options, statistics);
  for (int i = 0; i < 20; ++i) {
    one.store("one " + std::to_string(i), answerOf(10));
    one.commit();
    other.store("other " + std::to_string(i), answerOf(10));
    other.commit();
  }
  EXPECT_TRUE(one.find("other 19"));
  EXPECT_TRUE(other.find("one 19"));
}

/// A child writes, says after each commit how far it is, and is killed in the middle of its work.
TEST_F(DiskCacheTest, AKilledWriterLosesNothingThatWasCommitted) {
  for (int round = 0; round < 3; ++round) {
    int line[2];
    ASSERT_EQ(pipe(line), 0);
    const pid_t child = fork();
    if (child == 0) {
      DiskCache cache(options, statistics);
      for (std::int32_t i = 0;; ++i) {
        cache.store(std::to_string(round) + "/" + std::to_string(i), answerOf(5000, static_cast<char>('a' + i % 26)));
        if (i % 7 == 0) {
          cache.commit();
          if (write(line[1], &i, sizeof i) != sizeof i) {
            _exit(1);
          }
        }
      }
    }
    close(line[1]);
    std::int32_t committed = -1;
    while (committed < 200 * (round + 1)) {
      ASSERT_EQ(read(line[0], &committed, sizeof committed), static_cast<ssize_t>(sizeof committed));
    }
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    while (read(line[0], &committed, sizeof committed) == sizeof committed) {
    }
    close(line[0]);

    DiskCache cache(options, statistics);
    for (std::int32_t i = 0; i <= committed; ++i) {
      const auto found = cache.find(std::to_string(round) + "/" + std::to_string(i));
      ASSERT_TRUE(found) << round << "/" << i;
      ASSERT_EQ(*found->body, *answerOf(5000, static_cast<char>('a' + i % 26)).body);
    }
    cache.store("and it goes on", answerOf(10));
    ASSERT_TRUE(cache.find("and it goes on"));
  }
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file().c_str(), &database), SQLITE_OK);
  std::string verdict;
  sqlite3_exec(
      database, "PRAGMA integrity_check",
      [](void* text, int, char** values, char**) {
        *static_cast<std::string*>(text) += values[0];
        return 0;
      },
      &verdict, nullptr);
  sqlite3_close(database);
  EXPECT_EQ(verdict, "ok");
}

TEST_F(DiskCacheTest, TheWorkerFindsWhatWasJustStored) {
  CacheWorker worker(options, statistics);
  for (int i = 0; i < 200; ++i) {
    const std::string key = std::to_string(i);
    std::promise<bool> promise;
    worker.store(key, answerOf(2000));
    worker.find(key, [&](std::optional<CachedAnswer> found) { promise.set_value(found.has_value()); });
    ASSERT_TRUE(promise.get_future().get());
  }
  worker.remove("7");
  std::promise<bool> promise;
  worker.find("7", [&](std::optional<CachedAnswer> found) { promise.set_value(found.has_value()); });
  EXPECT_FALSE(promise.get_future().get());
  worker.drain();
}

TEST_F(DiskCacheTest, TheWorkerWritesWhatWaitsBeforeItEnds) {
  {
    CacheWorker worker(options, statistics);
    for (int i = 0; i < 300; ++i) {
      worker.store(std::to_string(i), answerOf(2000));
    }
  }
  DiskCache cache(options, statistics);
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(cache.find(std::to_string(i))) << i;
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
