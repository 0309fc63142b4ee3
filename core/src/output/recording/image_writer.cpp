#include "output/recording/image_writer.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/media.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kMostWaiting = 24;  // 64 MiB of pictures of 1280 x 720

/// Chooses PNG settings for speed. By default libpng tries every
/// predictor on every row, which takes twice the time for files 3 to 9 percent smaller; OpenCV uses
/// one predictor unless a level is given. The residue of a picture hardly repeats itself, so
/// Huffman coding suffices. Masks and depths consist of runs, for which OpenCV's default
/// (run-length) is right.
std::vector<int> compression(const std::filesystem::path& file, const cv::Mat& image) {
  if (image.type() != CV_8UC3 || file.extension() != ".png") return {};
  return {cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_HUFFMAN_ONLY};
}

}  // namespace

void write_picture(const std::filesystem::path& file, const cv::Mat& image,
                   const std::vector<int>& parameters) {
  bool written = false;
  try {
    written = write_image(file.string(), image, parameters);
  } catch (const cv::Exception&) {
  }
  if (written) return;
  const std::string why = why_not_written(file);
  std::error_code ignored;
  std::filesystem::remove(file, ignored);  // half a picture
  throw OutputError(fmt::format(
      "{}: the image cannot be written{}; check that there is space, or name another folder with "
      "--out",
      file.string(), why.empty() ? "" : ": " + why));
}

struct ImageWriter::Impl {
  explicit Impl(int threads)
      : arena(threads > 0 ? threads + 1 : oneapi::tbb::task_arena::automatic) {}

  void wait() {
    arena.execute([&] { tasks.wait(); });
  }

  void write_now(const std::filesystem::path& file, const cv::Mat& image) {
    if (stopped) return;
    try {
      write_picture(file, image, compression(file, image));
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
      stopped = true;
    }
  }

  void rethrow() {
    if (!stopped) return;
    const std::lock_guard lock(mutex);
    std::rethrow_exception(error);
  }

  std::atomic<int> waiting = 0;
  std::atomic<bool> stopped = false;
  std::mutex mutex;
  std::exception_ptr error;  // the first; guarded by the mutex
  oneapi::tbb::task_arena arena;
  oneapi::tbb::task_group tasks;
};

ImageWriter::ImageWriter(int threads) : impl_(std::make_unique<Impl>(threads)) {}

ImageWriter::~ImageWriter() {
  impl_->stopped = true;
  impl_->wait();
}

void ImageWriter::write(std::filesystem::path file, cv::Mat image) {
  impl_->rethrow();
  if (impl_->waiting >= kMostWaiting) {
    impl_->write_now(file, image);
    impl_->rethrow();
    return;
  }
  ++impl_->waiting;
  impl_->arena.execute([&] {
    impl_->tasks.run([impl = impl_.get(), file = std::move(file), image = std::move(image)] {
      impl->write_now(file, image);
      --impl->waiting;
    });
  });
}

void ImageWriter::wait() {
  impl_->wait();
  impl_->rethrow();
}

}  // namespace hypotrack::internal
