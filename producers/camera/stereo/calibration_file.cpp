#include "producers/camera/stereo/calibration_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core.hpp>

#include "core/program/whole_file.h"
#include "producers/camera/stereo/zed_ini.h"

namespace dance {
namespace {

// OpenCV's files with all views of a calibration stay below a tenth of it.
constexpr std::size_t kMostCalibration_bytes = 4u << 20;
constexpr const char* kMakeOne = "make one with dance capture --calibrate";

Result<std::string> read_small_file(const std::string& path) {
  auto text = read_whole_file(path, kMostCalibration_bytes);
  if (!text) return fail(fmt::format("{}; {}", text.error().what, kMakeOne));
  if (text->empty()) return fail(fmt::format("{} is empty; {}", path, kMakeOne));
  return text;
}

class CvFile {
 public:
  CvFile(const cv::FileStorage& storage, const std::string& name)
      : storage_(storage), name_(name) {}

  bool has(const char* key) const { return !storage_[key].empty(); }

  Result<int> whole(const char* key) const {
    const cv::FileNode node = storage_[key];
    if (!node.isInt())
      return fail(fmt::format("{} has no whole number {}; {}", name_, key, kMakeOne));
    return static_cast<int>(node);
  }

  // Of any number type, as doubles; rows 0 is any count of up to 14.
  Result<cv::Mat_<double>> matrix(const char* key, int rows, int cols) const {
    const cv::FileNode node = storage_[key];
    cv::Mat read;
    if (node.isMap()) node >> read;
    if (read.empty() || read.channels() != 1 || read.dims != 2)
      return fail(fmt::format("{} has no matrix {}; {}", name_, key, kMakeOne));
    const bool is_list = rows == 0;
    if (is_list ? std::min(read.rows, read.cols) != 1 || read.total() > 14
                : read.rows != rows || read.cols != cols)
      return fail(fmt::format("{}: {} has {} x {} numbers; {}", name_, key, read.rows, read.cols,
                              kMakeOne));
    cv::Mat_<double> out;
    read.convertTo(out, CV_64F);
    return is_list ? cv::Mat_<double>(out.reshape(1, 1)) : out;
  }

  Result<Pinhole> camera(const char* matrix_key, const char* distortion_key) const {
    Pinhole camera;
    camera.is_measured = true;
    DANCE_TRY(camera.width_px, whole("image_width"));
    DANCE_TRY(camera.height_px, whole("image_height"));
    DANCE_TRY(const cv::Mat_<double> m, matrix(matrix_key, 3, 3));
    camera.fx_px = m(0, 0);
    camera.fy_px = m(1, 1);
    camera.cx_px = m(0, 2);
    camera.cy_px = m(1, 2);
    DANCE_TRY(const cv::Mat_<double> d, matrix(distortion_key, 0, 0));
    for (int i = 0; i < d.cols; ++i) {
      // OpenCV's richer lens models have more than five.
      if (i >= 5 && d(0, i) != 0.0)
        return fail(
            fmt::format("{}: {} has more than five coefficients, and five are understood; {}",
                        name_, distortion_key, kMakeOne));
      if (i < 5) camera.distortion[static_cast<std::size_t>(i)] = d(0, i);
    }
    return checked(camera, name_ + ": " + matrix_key);
  }

 private:
  const cv::FileStorage& storage_;
  const std::string& name_;
};

Result<Calibration> read_calibration(const CvFile& file, const std::string& name) {
  if (file.has("M1") || file.has("M2")) {
    StereoRig rig;
    DANCE_TRY(rig.left, file.camera("M1", "D1"));
    DANCE_TRY(rig.right, file.camera("M2", "D2"));
    DANCE_TRY(const cv::Mat_<double> r, file.matrix("R", 3, 3));
    DANCE_TRY(const cv::Mat_<double> t, file.matrix("T", 0, 0));
    if (t.cols != 3)
      return fail(fmt::format("{}: T has {} numbers and needs 3; {}", name, t.cols, kMakeOne));
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) rig.R_RL(i, j) = r(i, j);
      rig.p_RL_m(i) = t(0, i);
    }
    DANCE_TRY(const StereoRig good, checked(rig, name));
    return Calibration{good.left, good};
  }
  if (!file.has("camera_matrix"))
    return fail(fmt::format(
        "{} holds neither camera_matrix (one camera) nor M1, M2, R, T (two); {}", name, kMakeOne));
  DANCE_TRY(const Pinhole camera, file.camera("camera_matrix", "distortion_coefficients"));
  return Calibration{camera, std::nullopt};
}

cv::Mat_<double> matrix_of(const Pinhole& camera) {
  return (cv::Mat_<double>(3, 3) << camera.fx_px, 0.0, camera.cx_px, 0.0, camera.fy_px,
          camera.cy_px, 0.0, 0.0, 1.0);
}
cv::Mat_<double> distortion_of(const Pinhole& camera) {
  return cv::Mat_<double>(1, 5, const_cast<double*>(camera.distortion.data())).clone();
}

std::string text_of(const Calibration& calibration, double rms_px) {
  cv::FileStorage storage(".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  storage << "image_width" << calibration.camera.width_px;
  storage << "image_height" << calibration.camera.height_px;
  storage << "reprojection_rms_px" << rms_px;
  if (!calibration.pair) {
    storage << "camera_matrix" << matrix_of(calibration.camera);
    storage << "distortion_coefficients" << distortion_of(calibration.camera);
    return storage.releaseAndGetString();
  }
  const StereoRig& rig = *calibration.pair;
  cv::Mat_<double> r(3, 3);
  cv::Mat_<double> t(3, 1);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r(i, j) = rig.R_RL(i, j);
    t(i, 0) = rig.p_RL_m(i);
  }
  storage << "M1" << matrix_of(rig.left) << "D1" << distortion_of(rig.left);
  storage << "M2" << matrix_of(rig.right) << "D2" << distortion_of(rig.right);
  storage << "R" << r << "T" << t;
  return storage.releaseAndGetString();
}

}  // namespace

Result<Calibration> parse_opencv_calibration(std::string_view text, const std::string& name) {
  try {
    const cv::FileStorage storage(std::string(text),
                                  cv::FileStorage::READ | cv::FileStorage::MEMORY);
    if (!storage.isOpened())
      return fail(fmt::format("{} is no file of OpenCV's; {}", name, kMakeOne));
    return read_calibration(CvFile(storage, name), name);
  } catch (const std::exception&) {
    return fail(fmt::format("{} is damaged, or no file of OpenCV's; {}", name, kMakeOne));
  }
}

Result<Calibration> load_calibration(const std::string& path, int width_px, int height_px) {
  DANCE_TRY(const std::string text, read_small_file(path));
  if (looks_like_zed_ini(text)) {
    DANCE_TRY(const StereoRig rig, parse_zed_ini(text, path, width_px, height_px));
    return Calibration{rig.left, rig};
  }
  DANCE_TRY(Calibration read, parse_opencv_calibration(text, path));
  DANCE_TRY(read.camera, fitted(read.camera, width_px, height_px, path));
  if (read.pair) {
    read.pair->left = read.camera;
    DANCE_TRY(read.pair->right, fitted(read.pair->right, width_px, height_px, path));
  }
  return read;
}

Result<void> save_calibration(const std::string& path, const Calibration& calibration,
                              double rms_px) {
  return write_whole_file(path, text_of(calibration, rms_px));
}

}  // namespace dance
