#include "globebrowsing/network/request_queue.h"

#include <set>

#include <gmock/gmock.h>

namespace meridian::globebrowsing {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using Ids = std::vector<RequestQueue::Id>;

/// A queue whose jitter always takes the whole delay, nearly, and whose clock stands where it is put.
class RequestQueueTest : public testing::Test {
 protected:
  RequestQueue make(int perHost, int total) {
    return {{.perHost = perHost, .perHostMultiplexed = perHost * 3, .total = total}, retry, [this] { return random; }};
  }
  Ids startAll(RequestQueue& queue) const {
    Ids started;
    while (const auto id = queue.start(now)) {
      started.push_back(*id);
    }
    return started;
  }
  bool fail(RequestQueue& queue, RequestQueue::Id id, Outcome outcome = Outcome::Unreachable) const {
    return queue.finish(id, {outcome}, now);
  }

  RetryOptions retry{.attempts = 3,
                     .firstDelay = milliseconds(100),
                     .maximumDelay = milliseconds(1000),
                     .maximumRetryAfter = milliseconds(5000),
                     .failuresUntilDown = 4,
                     .firstPause = milliseconds(1000),
                     .maximumPause = milliseconds(4000)};
  double random = 0.0;
  RequestQueue::TimePoint now{};
};

TEST_F(RequestQueueTest, GreatestPriorityFirstThenTheOrderOfAsking) {
  RequestQueue queue = make(10, 10);
  queue.add(1, "a", 1.0);
  queue.add(2, "b", 5.0);
  queue.add(3, "a", 5.0);
  queue.add(4, "a", 2.0);
  queue.setPriority(4, 9.0);
  queue.setPriority(99, 9.0);
  EXPECT_THAT(startAll(queue), ElementsAre(4, 2, 3, 1));
}

TEST_F(RequestQueueTest, KeepsBothLimits) {
  RequestQueue queue = make(2, 3);
  for (RequestQueue::Id id = 1; id <= 4; ++id) {
    queue.add(id, "a", 10.0);
    queue.add(id + 10, "b", 1.0);
  }
  EXPECT_THAT(startAll(queue), ElementsAre(1, 2, 11)) << "a busy host leaves the others their turn";
  queue.finish(1, {}, now);
  queue.finish(11, {}, now);
  EXPECT_THAT(startAll(queue), ElementsAre(3, 12));
  queue.setMultiplexed("a");
  queue.finish(12, {}, now);
  EXPECT_THAT(startAll(queue), ElementsAre(4));
}

TEST_F(RequestQueueTest, ARequestThatWaitsToBeTriedAgainTakesNoPlace) {
  random = 0.5;
  RequestQueue queue = make(1, 1);
  queue.add(1, "a", 9.0);
  queue.add(2, "a", 1.0);
  EXPECT_THAT(startAll(queue), ElementsAre(1));
  EXPECT_TRUE(fail(queue, 1, Outcome::ServerError));
  EXPECT_THAT(startAll(queue), ElementsAre(2));
  EXPECT_EQ(queue.wakeAt(now), now + milliseconds(50));
  queue.finish(2, {}, now);
  now += milliseconds(49);
  EXPECT_THAT(startAll(queue), ElementsAre());
  now += milliseconds(1);
  EXPECT_EQ(queue.wakeAt(now), std::nullopt) << "what is due is no reason to wake again and again";
  EXPECT_THAT(startAll(queue), ElementsAre(1));
}

TEST_F(RequestQueueTest, GivesUpAfterTheLastAttemptWhileTheServerAnswers) {
  RequestQueue queue = make(4, 4);
  queue.add(1, "a", 1.0);
  for (int attempt = 1; attempt <= 3; ++attempt) {
    ASSERT_THAT(startAll(queue), ElementsAre(1));
    EXPECT_EQ(fail(queue, 1, Outcome::ServerError), attempt < 3);
    now += milliseconds(5000);
  }
  EXPECT_EQ(queue.size(), 0U);
}

TEST_F(RequestQueueTest, OneAddressThatHangsFailsWhileOthersAreAnsweredAndOnlyThen) {
  RequestQueue queue = make(4, 4);
  queue.add(1, "a", 1.0);
  for (int round = 0; round < 20; ++round) {
    ASSERT_THAT(startAll(queue), ElementsAre(1));
    ASSERT_TRUE(fail(queue, 1)) << "nothing says that the server is up";
    now += milliseconds(4000);
  }
  bool waits = true;
  for (RequestQueue::Id id = 2; id < 6 && waits; ++id) {
    queue.add(id, "a", 9.0);
    const Ids started = startAll(queue);
    ASSERT_EQ(started.front(), id);
    ASSERT_FALSE(queue.finish(id, {}, now));
    if (started.size() == 1) {
      ASSERT_THAT(startAll(queue), ElementsAre(1));
    }
    waits = fail(queue, 1);
    EXPECT_EQ(waits, id < 4) << "three attempts";
    now += milliseconds(4000);
  }
  EXPECT_FALSE(waits);
}

TEST_F(RequestQueueTest, OneThatIsNotPatientIsOverWhenItsHostIsDown) {
  RequestQueue queue = make(4, 4);
  for (RequestQueue::Id id = 1; id <= 4; ++id) {
    queue.add(id, "a", 1.0, id % 2 == 0);
  }
  EXPECT_EQ(startAll(queue).size(), 4U);
  EXPECT_TRUE(fail(queue, 1));
  EXPECT_TRUE(fail(queue, 2));
  EXPECT_TRUE(fail(queue, 4));
  EXPECT_FALSE(fail(queue, 3)) << "the fourth failure is the one that tells";
}

TEST_F(RequestQueueTest, FinalIsFinal) {
  RequestQueue queue = make(4, 4);
  queue.add(1, "a", 1.0);
  startAll(queue);
  EXPECT_FALSE(fail(queue, 1, Outcome::Final));
}

TEST_F(RequestQueueTest, OneRequestSeesWhetherADeadServerIsBackAndNoneIsLost) {
  RequestQueue queue = make(4, 100);
  for (RequestQueue::Id id = 1; id <= 100; ++id) {
    queue.add(id, "a", 1.0);
  }
  for (const RequestQueue::Id id : startAll(queue)) {
    EXPECT_TRUE(fail(queue, id));
  }
  EXPECT_FALSE(queue.mayAsk("a", now));
  EXPECT_TRUE(queue.mayAsk("b", now));
  EXPECT_EQ(queue.hostsDown(), 1U);
  std::set<RequestQueue::Id> probes;
  std::size_t sent = 0;
  for (int second = 0; second < 1000; ++second) {
    now += milliseconds(1000);
    const Ids started = startAll(queue);
    ASSERT_LE(started.size(), 1U);
    for (const RequestQueue::Id id : started) {
      ++sent;
      probes.insert(id);
      ASSERT_TRUE(fail(queue, id)) << "none fails for good while the server is down";
    }
  }
  EXPECT_EQ(queue.size(), 100U);
  EXPECT_LE(sent, 255U) << "one each 4 s once the pauses have grown";
  EXPECT_GT(probes.size(), 50U) << "not always the same: it may be the one that the server hangs on";

  now += milliseconds(4000);
  const Ids probe = startAll(queue);
  ASSERT_EQ(probe.size(), 1U);
  queue.finish(probe.front(), {}, now);
  EXPECT_EQ(startAll(queue).size(), 4U);
}

TEST_F(RequestQueueTest, RetryAfterHoldsTheWholeHost) {
  RequestQueue queue = make(4, 4);
  queue.add(1, "a", 1.0);
  queue.add(2, "b", 1.0);
  EXPECT_THAT(startAll(queue), ElementsAre(1, 2));
  EXPECT_TRUE(queue.finish(1, {Outcome::Unavailable, milliseconds(3000)}, now));
  queue.add(3, "a", 9.0);
  queue.add(4, "b", 1.0);
  EXPECT_THAT(startAll(queue), ElementsAre(4));
  now += milliseconds(2999);
  EXPECT_THAT(startAll(queue), ElementsAre());
  now += milliseconds(1);
  EXPECT_THAT(startAll(queue), ElementsAre(3)) << "one at first";
  queue.finish(3, {}, now);
  EXPECT_THAT(startAll(queue), ElementsAre(1));
}

TEST_F(RequestQueueTest, RetryAfterHoldsTheHostWhateverElseWasUnderWay) {
  RequestQueue queue = make(4, 4);
  for (RequestQueue::Id id = 1; id <= 4; ++id) {
    queue.add(id, "a", 1.0);
  }
  ASSERT_EQ(startAll(queue).size(), 4U);
  ASSERT_TRUE(queue.finish(1, {Outcome::Unavailable, milliseconds(3000)}, now));
  now += milliseconds(5);
  queue.finish(2, {}, now);
  EXPECT_FALSE(queue.mayAsk("a", now));
  EXPECT_THAT(startAll(queue), ElementsAre()) << "it has been asked to wait, and not been told otherwise";
  ASSERT_TRUE(queue.finish(3, {Outcome::Unavailable, milliseconds(1000)}, now));
  queue.finish(4, {}, now);
  EXPECT_THAT(queue.recallProbes("a"), ElementsAre());
  EXPECT_EQ(queue.wakeAt(now), now + milliseconds(2995));
  now += milliseconds(2994);
  EXPECT_THAT(startAll(queue), ElementsAre());
  now += milliseconds(1);
  const Ids probe = startAll(queue);
  ASSERT_EQ(probe.size(), 1U);
  queue.finish(probe.front(), {}, now);
  EXPECT_EQ(startAll(queue).size(), 1U);
}

TEST_F(RequestQueueTest, ACancelledProbeMakesRoomForTheNext) {
  RequestQueue queue = make(4, 4);
  for (RequestQueue::Id id = 1; id <= 6; ++id) {
    queue.add(id, "a", 1.0);
  }
  for (const RequestQueue::Id id : startAll(queue)) {
    fail(queue, id);
  }
  now += milliseconds(1000);
  const Ids probe = startAll(queue);
  ASSERT_EQ(probe.size(), 1U);
  queue.remove(probe.front(), now);
  EXPECT_EQ(startAll(queue).size(), 1U);
}

TEST_F(RequestQueueTest, AProbeThatHangsDoesNotKeepTheNextFromGoing) {
  RequestQueue queue = make(4, 4);
  for (RequestQueue::Id id = 1; id <= 6; ++id) {
    queue.add(id, "a", 1.0);
  }
  for (const RequestQueue::Id id : startAll(queue)) {
    fail(queue, id);
  }
  now += milliseconds(1000);
  const Ids hanging = startAll(queue);
  ASSERT_EQ(hanging.size(), 1U);
  EXPECT_EQ(queue.wakeAt(now), now + milliseconds(4000));
  now += milliseconds(4000);
  const Ids second = startAll(queue);
  ASSERT_EQ(second.size(), 1U);
  queue.finish(second.front(), {}, now);
  EXPECT_TRUE(fail(queue, hanging.front()));
  EXPECT_TRUE(queue.mayAsk("a", now));
  EXPECT_EQ(startAll(queue).size(), 4U);
}

TEST_F(RequestQueueTest, ProbesThatHangAreRecalledOnceTheHostIsUp) {
  RequestQueue queue = make(10, 10);
  for (RequestQueue::Id id = 1; id <= 6; ++id) {
    queue.add(id, "a", 1.0);
  }
  for (const RequestQueue::Id id : startAll(queue)) {
    fail(queue, id);
  }
  now += retry.maximumPause;
  const Ids hanging = startAll(queue);
  ASSERT_EQ(hanging.size(), 1U);
  EXPECT_THAT(queue.recallProbes("a"), ElementsAre()) << "it is still down";
  now += retry.maximumPause;
  const Ids answered = startAll(queue);
  ASSERT_EQ(answered.size(), 1U);
  EXPECT_FALSE(queue.finish(answered.front(), {}, now));
  EXPECT_EQ(queue.recallProbes("a"), hanging);
  EXPECT_FALSE(queue.isRunning(hanging.front()));
  EXPECT_THAT(queue.recallProbes("a"), ElementsAre());
  now += retry.maximumDelay;
  EXPECT_EQ(startAll(queue).size(), 5U) << "the one that hung as well";
  EXPECT_EQ(queue.running(), 5U);
}

TEST_F(RequestQueueTest, RemovesInAnyState) {
  random = 0.9;
  RequestQueue queue = make(2, 2);
  for (RequestQueue::Id id = 1; id <= 3; ++id) {
    queue.add(id, "a", 1.0);
  }
  startAll(queue);
  EXPECT_TRUE(fail(queue, 1, Outcome::ServerError));
  queue.remove(1, now);  // delayed
  queue.remove(2, now);  // running
  queue.remove(3, now);  // waiting
  queue.remove(3, now);
  EXPECT_EQ(queue.size(), 0U);
  EXPECT_EQ(queue.running(), 0U);
  now += milliseconds(5000);
  EXPECT_THAT(startAll(queue), ElementsAre());
  EXPECT_EQ(queue.wakeAt(now), std::nullopt);
}

}  // namespace
}  // namespace meridian::globebrowsing
