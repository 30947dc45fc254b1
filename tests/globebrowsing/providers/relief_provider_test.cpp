#include "globebrowsing/providers/relief_provider.h"

#include <cmath>
#include <fstream>

#include <glm/geometric.hpp>

#include "provider_fixture.h"

namespace meridian::globebrowsing {
namespace {

template <class Provider>
std::shared_ptr<Provider> make(Fields fields, const std::string& folder = "/data") {
  const auto made = makeProvider(requestFor(std::move(fields), folder));
  EXPECT_TRUE(made) << (made ? "" : made.error().message());
  return made ? std::dynamic_pointer_cast<Provider>(*made) : nullptr;
}

TEST(ReliefProvider, HillshadesLightFollowsItsProperties) {
  const auto provider = make<HillshadeProvider>({{"Type", "Hillshade"}, {"Azimuth", 90.0}, {"ZFactor", 3.0}});
  ASSERT_NE(provider, nullptr);
  EXPECT_FALSE(provider->hasTiles());
  const float half = std::sqrt(0.5F);
  EXPECT_LT(glm::distance(provider->relief()->parameters, glm::vec4(half, 0.0F, half, 3.0F)), 1e-6F);
  ASSERT_TRUE(provider->properties()->property("Azimuth")->set(180.0));
  ASSERT_TRUE(provider->properties()->property("Altitude")->set(0.0));
  EXPECT_LT(glm::distance(provider->relief()->parameters, glm::vec4(0.0F, -1.0F, 0.0F, 3.0F)), 1e-6F);
  EXPECT_FALSE(provider->properties()->property("Altitude")->set(91.0));
}

TEST(ReliefProvider, RampsAreRescaledByTheRange) {
  const auto provider = make<RampProvider>({{"Type", "ColorRelief"},
                                            {"ColorRamp", "0% blue; 0 green; 100% white"},
                                            {"Range", Value(glm::dvec2(-100.0, 500.0))}});
  ASSERT_NE(provider, nullptr);
  const auto before = provider->relief()->ramp;
  ASSERT_NE(before, nullptr);
  EXPECT_EQ(before->stops.front().value, -100.0);
  EXPECT_EQ(provider->relief()->ramp, before) << "made once";
  provider->range.put({-200.0, 900.0});
  EXPECT_EQ(provider->relief()->ramp->stops.front().value, -200.0);
  EXPECT_EQ(provider->relief()->ramp->stops[1].value, 0.0);
  EXPECT_EQ(provider->relief()->ramp->stops.back().value, 900.0);
}

TEST(ReliefProvider, AWrongRampWhileItRunsLeavesTheOneBefore) {
  const auto provider = make<RampProvider>({{"Type", "Slope"}});
  ASSERT_NE(provider, nullptr);
  const auto before = provider->relief()->ramp;
  provider->colourRamp.put("0 mauve");
  EXPECT_EQ(provider->relief()->ramp, before);
  EXPECT_NE(provider->relief()->problem.find("mauve"), std::string::npos);
  provider->colourRamp.put("0 violet");
  EXPECT_NE(provider->relief()->ramp, before);
  EXPECT_TRUE(provider->relief()->problem.empty());
}

TEST(ReliefProvider, ReadsARampFileWhenItIsOpened) {
  const TemporaryFolder folder("ramp");
  std::ofstream(folder.path() + "/ramp.txt") << "0 green\n4000 white\n";
  std::ofstream(folder.path() + "/bad.txt") << "0 green\n4000 wite\n";
  const auto provider = make<RampProvider>({{"Type", "ColorRelief"}, {"ColorRampFile", "ramp.txt"}}, folder.path());
  ASSERT_NE(provider, nullptr);
  EXPECT_TRUE(provider->check());
  EXPECT_EQ(provider->relief()->ramp, nullptr) << "nothing is read before";
  ASSERT_TRUE(provider->open());
  ASSERT_NE(provider->relief()->ramp, nullptr);
  EXPECT_EQ(provider->relief()->ramp->stops.back().value, 4000.0);
  EXPECT_EQ(provider->colourRamp.get(), "0 green\n4000 white\n");

  const auto bad = make<RampProvider>({{"Type", "ColorRelief"}, {"ColorRampFile", "bad.txt"}}, folder.path());
  const Result<void> opened = bad->open();
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message().find("bad.txt"), std::string::npos);
  EXPECT_NE(opened.error().message().find("wite"), std::string::npos);
  EXPECT_EQ(bad->relief()->ramp, nullptr);
  bad->colourRamp.put("0 green\n4000 white\n");
  EXPECT_NE(bad->relief()->ramp, nullptr) << "set while it runs";
  const auto none = make<RampProvider>({{"Type", "ColorRelief"}, {"ColorRampFile", "none.txt"}}, folder.path());
  EXPECT_FALSE(none->check());
  EXPECT_FALSE(none->open());
}

TEST(ReliefProvider, SaysWhichKeyIsWrong) {
  struct Case {
    const char* type;
    const char* key;
    Value value;
  };
  for (const Case& one : {Case{"Hillshade", "Altitude", 100.0}, Case{"Hillshade", "Azimuth", "north"},
                          Case{"Isolines", "Interval", 0.0}, Case{"Isolines", "LineColor", "red"},
                          Case{"ColorRelief", "ColorRamp", "0 mauve"}, Case{"Slope", "Range", 3.0}}) {
    const auto made = makeProvider(requestFor({{"Type", one.type}, {one.key, one.value}}));
    ASSERT_FALSE(made) << one.key;
    EXPECT_EQ(made.error().where, std::string("mars.asset:4: Layers.ColorLayers[1].") + one.key);
  }
  const auto inner = makeProvider(requestFor(
      {{"Type", "TileProviderByLevel"},
       {"LevelTileProviders", listOf({tableOf({{"MaxLevel", 3}, {"TileProvider", tableOf({{"Type", "Slope"}})}})})}}));
  EXPECT_FALSE(inner) << "it has no tiles";
}

}  // namespace
}  // namespace meridian::globebrowsing
