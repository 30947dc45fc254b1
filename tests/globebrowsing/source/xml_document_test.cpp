#include "globebrowsing/source/xml_document.h"

#include "globebrowsing/source/service_exception.h"
#include "globebrowsing/source/service_text.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

std::string valueIn(const Bytes& bytes) {
  const auto document = XmlDocument::parse(bytes, "doc.xml");
  EXPECT_TRUE(document) << (document ? "" : document.error().message());
  return document ? text(document->root()) : "";
}

Bytes wide(std::u16string_view text, bool isBigEndian, bool hasMark) {
  Bytes bytes;
  const auto put = [&](char16_t unit) {
    const auto high = static_cast<std::uint8_t>(unit >> 8);
    const auto low = static_cast<std::uint8_t>(unit & 0xFF);
    bytes.push_back(isBigEndian ? high : low);
    bytes.push_back(isBigEndian ? low : high);
  };
  if (hasMark) {
    put(0xFEFF);
  }
  for (const char16_t unit : text) {
    put(unit);
  }
  return bytes;
}

TEST(XmlDocument, ReadsEncodings) {
  const std::string expected = "G\xC3\xA9o \xF0\x9F\x8C\x8D";
  EXPECT_EQ(valueIn(toBytes("<a>" + expected + "</a>")), expected);
  EXPECT_EQ(valueIn(toBytes("\xEF\xBB\xBF<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<a>" + expected + "</a>")),
            expected);
  for (const bool isBigEndian : {false, true}) {
    for (const bool hasMark : {false, true}) {
      EXPECT_EQ(
          valueIn(wide(u"<?xml version='1.0' encoding='UTF-16'?><a>G\u00E9o \U0001F30D</a>", isBigEndian, hasMark)),
          expected);
    }
  }
  EXPECT_EQ(valueIn(toBytes("<?xml version='1.0' encoding='ISO-8859-1'?><a>G\xE9o</a>")), "G\xC3\xA9o");
  EXPECT_EQ(valueIn(toBytes("<?xml version='1.0' encoding='windows-1252'?><a>\x80 5</a>")), "\xE2\x82\xAC 5");
  EXPECT_EQ(valueIn(toBytes("<?xml version='1.0' encoding='UTF-8'?><a>G\xE9o</a>")), "G\xC3\xA9o");
  EXPECT_EQ(valueIn(toBytes("<?xml version='1.0' encoding='UTF-16'?><a>x</a>")), "x");
}

TEST(XmlDocument, DoesNotExpandEntitiesOrReadDocumentTypes) {
  const std::string bomb =
      "<!DOCTYPE a [<!ENTITY x \"xxxxxxxxxx\"><!ENTITY y \"&x;&x;&x;&x;&x;&x;&x;&x;&x;&x;\">"
      "<!ENTITY z SYSTEM \"file:///etc/passwd\">]><a>&y;&z;&lt;&#233;</a>";
  EXPECT_EQ(valueIn(toBytes(bomb)), "&y;&z;<\xC3\xA9");
}

TEST(XmlDocument, ReadsAmpersandsThatNobodyEscaped) {
  EXPECT_EQ(valueIn(toBytes("<a>http://h/x?a=1&b=2</a>")), "http://h/x?a=1&b=2");
  EXPECT_EQ(valueIn(toBytes("<a><![CDATA[http://h/x?a=1&b=2]]></a>")), "http://h/x?a=1&b=2");
}

TEST(XmlDocument, TellsWhereItBreaks) {
  const auto broken = XmlDocument::parse("<a>\n<b>\n</c>\n</a>", "doc.xml");
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().where.substr(0, 9), "doc.xml:3") << broken.error().message();
  for (const std::string_view text :
       {std::string_view(), std::string_view(" \n"), std::string_view("no XML at all"), std::string_view("<"),
        std::string_view("<a"), std::string_view("<a>\0</a>", 8)}) {
    const auto read = XmlDocument::parse(text, "doc.xml");
    EXPECT_TRUE(!read || text.size() == 8) << text;
  }
  const auto document = XmlDocument::parse("<a>\n\n  <b/></a>", "doc.xml");
  EXPECT_EQ(document->placeOf(child(document->root(), "b")), "doc.xml:3");
}

TEST(XmlDocument, HasLimits) {
  std::string deep;
  for (int i = 0; i < 200'000; ++i) {
    deep += "<a>";
  }
  const auto tooDeep = XmlDocument::parse(deep + "</a>", "doc.xml");
  EXPECT_FALSE(tooDeep);
  std::string closed;
  for (int i = 0; i < 150; ++i) {
    closed = "<a>" + closed + "</a>";
  }
  const auto also = XmlDocument::parse(closed, "doc.xml");
  ASSERT_FALSE(also);
  EXPECT_NE(also.error().what.find("deep"), std::string::npos);
  EXPECT_FALSE(XmlDocument::parse(toBytes("<a>" + std::string(100, 'x') + "</a>"), "doc.xml", {50, 10}));
}

TEST(XmlDocument, FindsByNameWithoutPrefixAndCase) {
  const auto document = XmlDocument::parse(
      "<wms:A xmlns:wms='u'><ows:Title>t</ows:Title><b><C xlink:Href=' h '>1</C></b><B><c>2</c></B></wms:A>",
      "doc.xml");
  const pugi::xml_node root = document->root();
  EXPECT_TRUE(isNamed(root, "a"));
  EXPECT_EQ(text(root, "title"), "t");
  EXPECT_EQ(text(root, "B/c"), "1");
  EXPECT_EQ(attribute(child(root, "b/c"), "href"), "h");
  EXPECT_EQ(children(root, "b").size(), 2U);
  EXPECT_EQ(text(root, "x/y"), "");
  EXPECT_EQ(attribute(child(root, "x"), "y"), "");
}

TEST(ServiceText, PutsParametersIntoAddresses) {
  EXPECT_EQ(withParameters("http://h/p", {{"A", "1"}, {"B", "2"}}), "http://h/p?A=1&B=2");
  EXPECT_EQ(withParameters("http://h/p?", {{"A", "1"}}), "http://h/p?A=1");
  EXPECT_EQ(withParameters("http://h/p?map=/x.map&", {{"A", "1"}}), "http://h/p?map=/x.map&A=1");
  EXPECT_EQ(withParameters("http://h/p?a=0&request=GetCapabilities#f", {{"A", "1"}, {"REQUEST", "GetMap"}}),
            "http://h/p?A=1&REQUEST=GetMap");
  EXPECT_EQ(parameterOf("http://h/p?a=0&B=2#f", "b"), "2");
  EXPECT_EQ(parameterOf("http://h/p?a", "a"), "");
  EXPECT_FALSE(parameterOf("http://h/p", "a"));
}

TEST(ServiceText, ResolvesAddresses) {
  const std::string base = "http://h:80/a/b/tilemapresource.xml?x=/y/z";
  EXPECT_EQ(resolvedUrl(base, "0"), "http://h:80/a/b/0");
  EXPECT_EQ(resolvedUrl(base, "./0"), "http://h:80/a/b/0");
  EXPECT_EQ(resolvedUrl(base, "../0"), "http://h:80/a/0");
  EXPECT_EQ(resolvedUrl(base, "/0"), "http://h:80/0");
  EXPECT_EQ(resolvedUrl(base, "//g/0"), "http://g/0");
  EXPECT_EQ(resolvedUrl(base, "https://g/0?u=http://i"), "https://g/0?u=http://i");
  EXPECT_EQ(resolvedUrl(base, "?a=1"), "http://h:80/a/b/tilemapresource.xml?a=1");
  EXPECT_EQ(resolvedUrl("http://h", "0"), "http://h/0");
  EXPECT_EQ(resolvedUrl("/data/t/tilemapresource.xml", "0"), "/data/t/0");
  EXPECT_EQ(resolvedUrl("tilemapresource.xml", "0"), "0");
  // RFC 3986, section 5.4, as far as addresses of services go.
  const std::string rfc = "http://a/b/c/d;p?q";
  for (const auto& [reference, target] :
       std::initializer_list<std::pair<const char*, const char*>>{{"g", "http://a/b/c/g"},
                                                                  {"./g", "http://a/b/c/g"},
                                                                  {"g/", "http://a/b/c/g/"},
                                                                  {"/g", "http://a/g"},
                                                                  {"//g", "http://g"},
                                                                  {"?y", "http://a/b/c/d;p?y"},
                                                                  {"g?y", "http://a/b/c/g?y"},
                                                                  {"", "http://a/b/c/d;p?q"},
                                                                  {".", "http://a/b/c/"},
                                                                  {"./", "http://a/b/c/"},
                                                                  {"..", "http://a/b/"},
                                                                  {"../", "http://a/b/"},
                                                                  {"../g", "http://a/b/g"},
                                                                  {"../..", "http://a/"},
                                                                  {"../../g", "http://a/g"},
                                                                  {"../../../g", "http://a/g"},
                                                                  {"/./g", "http://a/g"},
                                                                  {"/../g", "http://a/g"},
                                                                  {"g.", "http://a/b/c/g."},
                                                                  {"..g", "http://a/b/c/..g"},
                                                                  {"./../g", "http://a/b/g"},
                                                                  {"./g/.", "http://a/b/c/g/"},
                                                                  {"g/./h", "http://a/b/c/g/h"},
                                                                  {"g/../h", "http://a/b/c/h"},
                                                                  {"g;x=1/../y", "http://a/b/c/y"},
                                                                  {"g?y/../x", "http://a/b/c/g?y/../x"}}) {
    EXPECT_EQ(resolvedUrl(rfc, reference), target) << reference;
  }
  EXPECT_EQ(resolvedUrl(rfc, "https://g/h/../i/{z}/./{x}.png?u=a/../b"), "https://g/i/{z}/{x}.png?u=a/../b");
  EXPECT_EQ(resolvedUrl("http://a", "../g"), "http://a/g");
  EXPECT_EQ(resolvedUrl("t/tilemapresource.xml", "../../0"), "../0");
  EXPECT_EQ(repairedUrl(" http:/h/x "), "http://h/x");
  EXPECT_EQ(repairedUrl("http://h/x"), "http://h/x");
}

TEST(ServiceText, ReadsAndWritesNumbers) {
  EXPECT_EQ(number(" +1.5e3 "), 1500.0);
  EXPECT_FALSE(number("1.5x"));
  EXPECT_FALSE(number("nan"));
  EXPECT_FALSE(number("1e999"));
  EXPECT_EQ(integer("2.0"), 2);
  EXPECT_FALSE(integer("2.5"));
  EXPECT_EQ(decimal(-20037508.342789244), "-20037508.3427892439");
  EXPECT_EQ(decimal(1e-5), "0.00001");
  EXPECT_EQ(decimal(-1e-15), "0");
  EXPECT_EQ(decimal(180.0), "180");
  EXPECT_EQ(boolean("TRUE"), true);
  EXPECT_EQ(boolean("0"), false);
  EXPECT_FALSE(boolean("maybe"));
  EXPECT_EQ(percentEncoded("a b/\xC3\xA9&="), "a%20b%2F%C3%A9%26%3D");
}

TEST(ServiceException, QuotesWhatServicesSay) {
  const auto said = [](std::string_view text) { return exceptionText(toBytes(text)).value_or("nothing"); };
  EXPECT_EQ(
      said("<?xml version='1.0'?><ServiceExceptionReport version='1.1.1'><ServiceException code='LayerNotDefined'>\n"
           "  msWMSLoadGetMapParams(): WMS server error. </ServiceException></ServiceExceptionReport>"),
      "msWMSLoadGetMapParams(): WMS server error.");
  EXPECT_EQ(said("<ows:ExceptionReport><ows:Exception exceptionCode='TileOutOfRange' locator='TileRow'>"
                 "<ows:ExceptionText>Row is too large</ows:ExceptionText></ows:Exception></ows:ExceptionReport>"),
            "Row is too large");
  EXPECT_EQ(said("<ExceptionReport><Exception exceptionCode='TileOutOfRange'/></ExceptionReport>"), "TileOutOfRange");
  EXPECT_EQ(said("{\"error\":{\"code\":499,\"message\":\"Token Required\",\"details\":[]}}"), "Token Required");
  EXPECT_EQ(said("<html><head><title>502 Bad Gateway</title></head><body><hr></body></html>").substr(0, 4), "502 ");
  EXPECT_EQ(said("<<<").substr(0, 3), "<<<");
  EXPECT_EQ(said("\x89PNG"), "nothing");
  EXPECT_EQ(said(""), "nothing");
  EXPECT_LT(said("<ServiceException>" + std::string(5000, 'x') + "</ServiceException>").size(), 210U);
}

}  // namespace
}  // namespace meridian::globebrowsing
