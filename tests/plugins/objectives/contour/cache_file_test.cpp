#include "cache_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <vector>

#include "hypotrack/api/files.hpp"
#include "model_contours.hpp"
#include "test_models.hpp"
#include "test_paths.hpp"

namespace hypotrack::contour {
namespace {

using testing::HasSubstr;

/// Outlines of two points per view, each with numbers of its own.
ContourViews some_views(int subdivisions) {
  Eigen::Matrix3Xf directions = sphere_directions(subdivisions);
  std::vector<std::uint32_t> first{0};
  std::vector<ContourPoint> points;
  for (Eigen::Index i = 0; i < directions.cols(); ++i) {
    for (int k = 0; k < 2; ++k) {
      const auto x = static_cast<float>(2 * i + k);
      points.push_back({{x, x + 0.25f, x + 0.5f}, {0, 0, 1}, {x, 0, 0}, {0, x, 0}, x / 3, x / 5});
    }
    first.push_back(static_cast<std::uint32_t>(points.size()));
  }
  return {{1, 2, 3}, std::move(directions), std::move(first), std::move(points)};
}

class ContourCache : public testing::Test {
 protected:
  CacheFile file(const Mesh& mesh, ViewSettings settings = {.subdivisions = 1}) const {
    return {folder_.path() / "in" / "a folder", mesh, settings};
  }
  /// Changes the bytes of the written file and returns the problem of reading it.
  template <class Change>
  std::string problem_after(const Change& change) const {
    const CacheFile cache = file(box_);
    EXPECT_EQ(cache.write(some_views(1)), "");
    std::string bytes = read_whole(cache.path()).value();
    change(bytes);
    std::ofstream(cache.path(), std::ios::binary) << bytes;
    std::string problem;
    EXPECT_FALSE(cache.read(problem).has_value());
    EXPECT_THAT(problem, HasSubstr(cache.path().string()));
    return problem;
  }

  const test::TemporaryDirectory folder_;
  const Mesh box_ = test::make_test_box().mesh;
};

TEST_F(ContourCache, GivesBackWhatWasWritten) {
  const ContourViews written = some_views(1);
  EXPECT_EQ(file(box_).write(written), "");
  std::string problem;
  const std::optional<ContourViews> read = file(box_).read(problem);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(problem, "");
  EXPECT_EQ(read->centre(), written.centre());
  EXPECT_EQ(read->directions(), written.directions());
  EXPECT_THAT(read->first(), testing::ElementsAreArray(written.first()));
  ASSERT_EQ(read->points().size(), written.points().size());
  for (std::size_t i = 0; i < read->points().size(); ++i) {
    EXPECT_EQ(read->points()[i].position, written.points()[i].position);
    EXPECT_EQ(read->points()[i].back, written.points()[i].back);
    EXPECT_EQ(read->points()[i].inside, written.points()[i].inside);
    EXPECT_EQ(read->points()[i].outside, written.points()[i].outside);
  }
}

TEST_F(ContourCache, IsEmptyBeforeAModelWasDrawn) {
  std::string problem;
  EXPECT_FALSE(file(box_).read(problem).has_value());
  EXPECT_EQ(problem, "");
}

TEST_F(ContourCache, HasAFileForEachMeshAndSetting) {
  const Mesh longer = test::make_test_box({0.06, 0.04, 0.13}).mesh;
  Mesh turned = box_;
  turned.triangles.row(0).swap(turned.triangles.row(1));
  const auto here = file(box_).path();
  EXPECT_EQ(here, file(box_).path());
  EXPECT_NE(here, file(longer).path());
  EXPECT_NE(here, file(turned).path());
  EXPECT_NE(here, file(box_, {.subdivisions = 2}).path());
  EXPECT_NE(here, file(box_, {.subdivisions = 1, .points = 100}).path());
}

TEST_F(ContourCache, RefusesTheFileOfAnotherModel) {
  const CacheFile other = file(test::make_test_box({0.06, 0.04, 0.13}).mesh);
  EXPECT_EQ(file(box_).write(some_views(1)), "");
  std::filesystem::copy_file(file(box_).path(), other.path());
  std::string problem;
  EXPECT_FALSE(other.read(problem).has_value());
  EXPECT_THAT(problem, HasSubstr("holds another model"));
}

TEST_F(ContourCache, RefusesBrokenFiles) {
  EXPECT_THAT(problem_after([](std::string& bytes) { bytes.resize(20); }),
              HasSubstr("ends within its header"));
  EXPECT_THAT(problem_after([](std::string& bytes) { bytes.clear(); }),
              HasSubstr("ends within its header"));
  EXPECT_THAT(problem_after([](std::string& bytes) { bytes.pop_back(); }), HasSubstr("is damaged"));
  EXPECT_THAT(problem_after([](std::string& bytes) { bytes += 'x'; }), HasSubstr("is damaged"));
  EXPECT_THAT(problem_after([](std::string& bytes) { bytes[bytes.size() / 2] ^= 1; }),
              HasSubstr("is damaged"));
  EXPECT_THAT(problem_after([](std::string& bytes) { bytes[0] = 'H'; }),
              HasSubstr("is no file of outlines"));
  // The centre of the views, in the header.
  EXPECT_THAT(problem_after([](std::string& bytes) { bytes[33] ^= 1; }), HasSubstr("is damaged"));
  // Counts that would ask for more memory than there is.
  EXPECT_THAT(problem_after([](std::string& bytes) { bytes.replace(24, 8, 8, '\xff'); }),
              HasSubstr("is damaged"));
}

TEST_F(ContourCache, RefusesAnotherVersionAndNamesBoth) {
  EXPECT_THAT(problem_after([](std::string& bytes) { bytes[16] = 77; }),
              HasSubstr("has version 77, expected 2"));
}

TEST_F(ContourCache, SurvivesProgramsThatWriteAtOnce) {
  std::vector<std::future<std::string>> writers;
  for (int i = 0; i < 8; ++i)
    writers.push_back(std::async(std::launch::async, [&] {
      std::string problem = file(box_).write(some_views(1));
      std::string of_reading;
      if (!file(box_).read(of_reading)) problem += "unreadable: " + of_reading;
      return problem;
    }));
  for (auto& writer : writers) EXPECT_EQ(writer.get(), "");
  const auto folder = file(box_).path().parent_path();
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST_F(ContourCache, SaysWhyItCannotBeWritten) {
  std::ofstream(folder_.path() / "in") << "a file where the folder should be";
  const std::string problem = file(box_).write(some_views(1));
  EXPECT_THAT(problem, HasSubstr(file(box_).path().string()));
  EXPECT_THAT(problem, HasSubstr("cannot be written"));
  EXPECT_THAT(problem, HasSubstr("`cache`"));
}

TEST_F(ContourCache, IsFilledByTheFirstUseOfAModel) {
  const auto model = std::make_shared<Model>(test::make_test_box());
  Params params;
  params.views.subdivisions = 0;
  params.cache = folder_.path();
  const ContourViews drawn = model_contours(model, params, {});
  const CacheFile cache(params.cache, model->data().mesh, params.views);
  ASSERT_TRUE(std::filesystem::exists(cache.path()));
  // What lies in the cache is used: it is not drawn again.
  EXPECT_EQ(cache.write(some_views(0)), "");
  EXPECT_EQ(model_contours(model, params, {}).centre(), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(drawn.centre(), Eigen::Vector3f(0, 0, 0));
}

}  // namespace
}  // namespace hypotrack::contour
