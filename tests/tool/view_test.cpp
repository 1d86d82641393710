// Pictures and pages.
#include <png.h>

#include <algorithm>
#include <array>
#include <regex>

#include "tool_runner.hpp"

namespace innersphere::test {
namespace {

struct Picture {
  unsigned width = 0;
  unsigned height = 0;
  std::vector<unsigned char> pixels;  // r, g, b
};

Picture readPng(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Picture picture;
  EXPECT_TRUE(png_image_begin_read_from_file(&image, path.c_str())) << image.message;
  image.format = PNG_FORMAT_RGB;
  picture.pixels.resize(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr)) << image.message;
  picture.width = image.width;
  picture.height = image.height;
  return picture;
}

// How many different colours there are, each rounded to 1/16 of its range.
std::size_t colours(const Picture& picture) {
  std::set<unsigned> found;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
    found.insert((picture.pixels[i] >> 4) << 8 | (picture.pixels[i + 1] >> 4) << 4 |
                 picture.pixels[i + 2] >> 4);
  }
  return found.size();
}

class View : public ToolTest {
 protected:
  void SetUp() override { succeed("pack torus --spheres 100 -o torus.cbor"); }
};

TEST_F(View, PictureHasTheSizeAndShowsSomething) {
  succeed("view torus.cbor --png torus.png --width 160 --height 90 --samples 4");
  const Picture picture = readPng(path("torus.png"));
  EXPECT_EQ(picture.width, 160u);
  EXPECT_EQ(picture.height, 90u);
  EXPECT_GT(colours(picture), 30u);
}

TEST_F(View, SurfaceAndSpheresDiffer) {
  const std::string size = " --width 80 --height 60 --samples 4";
  succeed("view torus.cbor --png surface.png --show surface" + size);
  succeed("view torus.cbor --png spheres.png --show spheres" + size);
  succeed("view torus.cbor --png again.png --show spheres" + size);
  const Picture surface = readPng(path("surface.png"));
  const Picture spheres = readPng(path("spheres.png"));
  const auto differences =
      std::inner_product(surface.pixels.begin(), surface.pixels.end(), spheres.pixels.begin(), 0,
                         std::plus<>(), [](int a, int b) { return std::abs(a - b) > 40; });
  EXPECT_GT(differences, 500);
  EXPECT_EQ(readFile(path("again.png")), readFile(path("spheres.png")));
}

TEST_F(View, PageIsSelfContained) {
  succeed("view torus.cbor --html torus.html");
  const std::string page = readFile(path("torus.html"));
  EXPECT_EQ(page.substr(0, 15), "<!DOCTYPE html>");
  EXPECT_EQ(page.find("{{"), std::string::npos) << "a part of the page is missing";
  EXPECT_NE(page.find("OrbitControls"), std::string::npos);
  // Nothing is loaded: no element names another file. The text of three.js itself holds addresses, in
  // comments.
  EXPECT_EQ(page.find("<link"), std::string::npos);
  EXPECT_EQ(page.find("<script src"), std::string::npos);
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(page.find("@import"), std::string::npos);

  const std::string start = "type=\"application/json\">";
  const std::size_t begin = page.find(start) + start.size();
  const auto film = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin))[0];
  EXPECT_EQ(film["title"], "torus.cbor");
  EXPECT_EQ(film["actors"].size(), 1u);
  EXPECT_EQ(film["poses"].get<std::string>().size(), 40u) << "one pose of seven numbers in base 64";
  EXPECT_EQ(film["shapes"][0]["spheres"].get<std::string>().size(), 2136u) << "100 spheres of four numbers";
}

// Its row has seven fields between white ones, a stretch of one colour each, from yellow to violet.
TEST_F(View, PicturesOfCoverageHaveAScale) {
  const Outcome outcome =
      run("view torus.cbor --colour coverage --width 300 --height 200 --samples 1 --png torus.png");
  EXPECT_NE(outcome.err.find("distance of the surface to the nearest sphere"), std::string::npos)
      << outcome.err;
  const Picture picture = readPng(path("torus.png"));
  std::size_t most = 0;
  for (unsigned y = 0; y < picture.height; ++y) {
    std::set<std::array<unsigned char, 3>> fields;
    unsigned stretch = 0;
    for (unsigned x = 1; x < picture.width; ++x) {
      const unsigned char* const pixel = &picture.pixels[3 * (y * picture.width + x)];
      stretch = std::equal(pixel, pixel + 3, pixel - 3) ? stretch + 1 : 0;
      if (stretch == 25 && pixel[2] < 250) fields.insert({pixel[0], pixel[1], pixel[2]});
    }
    most = std::max(most, fields.size());
  }
  EXPECT_EQ(most, 7u);
}

// A closed surface has half as many vertices as triangles; the bands of colours each have their own rim.
TEST_F(View, ColouredTrianglesShareVertices) {
  succeed("view torus.cbor --colour coverage --html torus.html");
  const std::string page = readFile(path("torus.html"));
  const std::string start = "type=\"application/json\">";
  const std::size_t begin = page.find(start) + start.size();
  const auto film = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin))[0];
  std::size_t vertices = 0, triangles = 0;
  for (const auto& shape : film["shapes"]) {
    if (!shape.contains("triangles")) continue;
    vertices += shape["vertices"].get<std::string>().size();
    triangles += shape["triangles"].get<std::string>().size();
  }
  EXPECT_GT(triangles, 0u);
  EXPECT_LT(vertices, triangles);
}

TEST_F(View, WithoutOutputsBothAreNamedAfterTheFile) {
  succeed("view torus.cbor --width 40 --height 30 --samples 1");
  EXPECT_EQ(files(), (std::set<std::string>{"torus.cbor", "torus.html", "torus.png"}));
}

TEST_F(View, SaysWhichAxisPointsUp) {
  const std::string view = "view torus.cbor --html torus.html --force";
  EXPECT_NE(run(view).err.find("--up y"), std::string::npos);
  EXPECT_NE(run(view + " --up y").err.find("--up z"), std::string::npos);
}

TEST_F(View, NamesCannotBreakThePage) {
  succeed("convert torus.cbor '<script>alert(1).cbor'");
  succeed("view '<script>alert(1).cbor' --html page.html");
  EXPECT_EQ(readFile(path("page.html")).find("<script>alert"), std::string::npos);
}

TEST_F(View, ShowsTheSpheresOfAClump) {
  succeed("pack lbracket --clump --spheres 12 -o bracket.json");
  succeed("view bracket.json --width 160 --height 90 --samples 4");
  EXPECT_GT(colours(readPng(path("bracket.png"))), 30u);
  EXPECT_NE(readFile(path("bracket.html")).find("12 spheres that overlap hold "), std::string::npos);
}

TEST_F(View, PacksASolidByName) {
  succeed("view lbracket --spheres 50 --png bracket.png --width 40 --height 30 --samples 1");
  EXPECT_EQ(files().count("bracket.png"), 1u);
}

}  // namespace
}  // namespace innersphere::test
