#include "tet_line_tracker/camera/calibration_file.h"

#include <cmath>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace tet_line_tracker {
namespace {

/// A YAML map that knows its place in the file, for errors that name the field.
class Section {
 public:
  Section(const YAML::Node& node, std::string place) : node_(node), place_(std::move(place)) {}

  bool has(const std::string& key) const { return node_.IsMap() && node_[key].IsDefined(); }

  Section section(const std::string& key) const {
    const YAML::Node child = require(key);
    if (!child.IsMap()) throw std::runtime_error(nameOf(key) + " is not a map");
    return {child, nameOf(key) + "."};
  }

  double number(const std::string& key) const { return toNumber(require(key), nameOf(key)); }

  int integer(const std::string& key) const { return toInteger(number(key), nameOf(key)); }

  static int toInteger(double value, const std::string& name) {
    if (value != std::floor(value) || std::abs(value) > 1e6) {
      throw std::runtime_error(name + " is " + std::to_string(value) + ", needs a whole number");
    }
    return static_cast<int>(value);
  }

  std::string text(const std::string& key, const std::string& otherwise = "") const {
    return has(key) && node_[key].IsScalar() ? node_[key].Scalar() : otherwise;
  }

  /// A list, also a list of lists row by row, or the `data` of a matrix; of `size` numbers unless that is 0.
  std::vector<double> numbers(const std::string& key, std::size_t size = 0) const {
    YAML::Node list = require(key);
    std::string name = nameOf(key);
    if (list.IsMap()) {
      list = list["data"];
      name += ".data";
    }
    if (!list.IsDefined() || !list.IsSequence()) throw std::runtime_error(name + " is not a list of numbers");
    std::vector<double> values;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string place = name + "[" + std::to_string(i) + "]";
      if (!list[i].IsSequence()) {
        values.push_back(toNumber(list[i], place));
      } else {
        for (std::size_t j = 0; j < list[i].size(); ++j) {
          values.push_back(toNumber(list[i][j], place + "[" + std::to_string(j) + "]"));
        }
      }
    }
    if (size != 0 && values.size() != size) {
      throw std::runtime_error(name + " has " + std::to_string(values.size()) + " numbers, needs " +
                               std::to_string(size));
    }
    return values;
  }

  std::string nameOf(const std::string& key) const { return place_ + key; }

 private:
  YAML::Node require(const std::string& key) const {
    if (!has(key)) throw std::runtime_error(nameOf(key) + " is missing");
    return node_[key];
  }

  static double toNumber(const YAML::Node& node, const std::string& name) {
    double value = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) {
      throw std::runtime_error(name + " is not a number");
    }
    if (!std::isfinite(value)) {
      throw std::runtime_error(name + " is " + node.Scalar() + ", needs a finite number");
    }
    return value;
  }

  YAML::Node node_;
  std::string place_;
};

/// Upper left 3x3 of a row-major matrix with rows of `stride` numbers. Throws unless it is a rotation.
Eigen::Matrix3d toRotation(const std::vector<double>& m, std::size_t stride, const std::string& name) {
  Eigen::Matrix3d rotation;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      rotation(static_cast<int>(row), static_cast<int>(column)) = m[stride * row + column];
    }
  }
  if (!(rotation * rotation.transpose()).isIdentity(1e-3) || rotation.determinant() < 0.0) {
    throw std::runtime_error(name + " is not a rotation");
  }
  return Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
}

Eigen::Isometry3d toIsometry(const std::vector<double>& m, const std::string& name) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = toRotation(m, 4, name);
  transform.translation() = Eigen::Vector3d(m[3], m[7], m[11]);
  return transform;
}

void setPinhole(const std::vector<double>& fx_fy_cx_cy, CameraCalibration* camera) {
  camera->fx = fx_fy_cx_cy[0];
  camera->fy = fx_fy_cx_cy[1];
  camera->cx = fx_fy_cx_cy[2];
  camera->cy = fx_fy_cx_cy[3];
}

CalibrationFile fromCameraInfoYaml(const Section& file) {
  const bool message = file.has("K");
  CalibrationFile result;
  result.format = "camera_info";
  result.name = file.text("camera_name");
  result.camera.width = file.integer(message ? "width" : "image_width");
  result.camera.height = file.integer(message ? "height" : "image_height");
  const std::vector<double> k = file.numbers(message ? "K" : "camera_matrix", 9);
  setPinhole({k[0], k[4], k[2], k[5]}, &result.camera);
  result.camera.model = file.text("distortion_model");
  const char* coefficients = message ? "D" : "distortion_coefficients";
  if (file.has(coefficients)) result.camera.distortion = file.numbers(coefficients);
  return result;
}

CalibrationFile fromKalibr(const Section& file, int index) {
  CalibrationFile result;
  result.format = "kalibr";
  result.name = "cam" + std::to_string(index);
  const Section camera = file.section(result.name);
  const std::vector<double> size = camera.numbers("resolution", 2);
  result.camera.width = Section::toInteger(size[0], camera.nameOf("resolution[0]"));
  result.camera.height = Section::toInteger(size[1], camera.nameOf("resolution[1]"));

  const std::string projection = camera.text("camera_model");
  const std::string distortion = camera.text("distortion_model");
  const bool plain = distortion == "none";
  if (projection == "pinhole" && (distortion == "radtan" || distortion == "equi" || plain)) {
    setPinhole(camera.numbers("intrinsics", 4), &result.camera);
    result.camera.model = distortion == "equi" ? "equidistant" : "plumb_bob";
    if (!plain) result.camera.distortion = camera.numbers("distortion_coeffs", 4);
  } else if (projection == "omni" && (distortion == "radtan" || plain)) {
    const std::vector<double> intrinsics = camera.numbers("intrinsics", 5);
    setPinhole({intrinsics.begin() + 1, intrinsics.end()}, &result.camera);
    result.camera.model = "mei";
    result.camera.distortion = plain ? std::vector<double>(4, 0.0) : camera.numbers("distortion_coeffs", 4);
    result.camera.distortion.insert(result.camera.distortion.begin(), intrinsics[0]);
  } else {
    throw std::runtime_error(camera.nameOf("camera_model") + " is \"" + projection +
                             "\" with distortion_model \"" + distortion +
                             "\"; known: pinhole with radtan, equi or none, omni with radtan or none");
  }
  if (camera.has("T_cam_imu")) {
    result.camera_from_imu = toIsometry(camera.numbers("T_cam_imu", 16), camera.nameOf("T_cam_imu"));
  }
  if (camera.has("timeshift_cam_imu")) result.imu_time_offset = camera.number("timeshift_cam_imu");
  return result;
}

/// The extrinsics of VINS: both forms move a point of the camera's frame to the IMU's.
std::optional<Eigen::Isometry3d> vinsExtrinsics(const Section& file, int index) {
  const std::string fusion = "body_T_cam" + std::to_string(index);
  if (file.has(fusion)) return toIsometry(file.numbers(fusion, 16), fusion).inverse();
  if (!file.has("extrinsicRotation") || !file.has("extrinsicTranslation")) return std::nullopt;
  const std::vector<double> t = file.numbers("extrinsicTranslation", 3);
  Eigen::Isometry3d imu_from_camera = Eigen::Isometry3d::Identity();
  imu_from_camera.linear() = toRotation(file.numbers("extrinsicRotation", 9), 3, "extrinsicRotation");
  imu_from_camera.translation() = Eigen::Vector3d(t[0], t[1], t[2]);
  return imu_from_camera.inverse();
}

std::vector<double> fields(const Section& section, std::initializer_list<const char*> keys) {
  std::vector<double> values;
  for (const char* key : keys) values.push_back(section.number(key));
  return values;
}

CalibrationFile fromCamodocal(const Section& file, int index) {
  CalibrationFile result;
  result.format = "camodocal";
  result.name = file.text("camera_name");
  result.camera.width = file.integer("image_width");
  result.camera.height = file.integer("image_height");
  const std::string model = file.text("model_type");
  const Section projection = file.section("projection_parameters");
  if (model == "PINHOLE") {
    result.camera.model = "plumb_bob";
    setPinhole(fields(projection, {"fx", "fy", "cx", "cy"}), &result.camera);
    result.camera.distortion = fields(file.section("distortion_parameters"), {"k1", "k2", "p1", "p2"});
  } else if (model == "KANNALA_BRANDT") {
    result.camera.model = "equidistant";
    setPinhole(fields(projection, {"mu", "mv", "u0", "v0"}), &result.camera);
    result.camera.distortion = fields(projection, {"k2", "k3", "k4", "k5"});
  } else if (model == "MEI") {
    result.camera.model = "mei";
    setPinhole(fields(projection, {"gamma1", "gamma2", "u0", "v0"}), &result.camera);
    result.camera.distortion = fields(file.section("distortion_parameters"), {"k1", "k2", "p1", "p2"});
    const double xi = file.section("mirror_parameters").number("xi");
    result.camera.distortion.insert(result.camera.distortion.begin(), xi);
  } else {
    throw std::runtime_error("model_type is \"" + model + "\"; known: PINHOLE, KANNALA_BRANDT, MEI");
  }
  result.camera_from_imu = vinsExtrinsics(file, index);
  if (file.has("td")) result.imu_time_offset = file.number("td");
  return result;
}

/// The file's text without OpenCV's "%YAML:1.0" line, which is not YAML.
std::string readWithoutDirective(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot be opened");
  std::stringstream text;
  std::string line;
  for (bool first = true; std::getline(in, line); first = false) {
    if (first && line.rfind("%YAML", 0) == 0) continue;
    text << line << '\n';
  }
  return text.str();
}

CalibrationFile parse(const std::string& path, int camera) {
  const YAML::Node root = YAML::Load(readWithoutDirective(path));
  if (!root.IsMap()) throw std::runtime_error("holds no YAML map");
  const Section file(root, "");
  CalibrationFile result;
  if (file.has("model_type")) {
    result = fromCamodocal(file, camera);
  } else if (file.has("camera_matrix") || file.has("K")) {
    result = fromCameraInfoYaml(file);
  } else if (file.has("cam" + std::to_string(camera)) || file.has("cam0")) {
    result = fromKalibr(file, camera);
  } else {
    throw std::runtime_error(
        "is none of the known formats (camera_matrix or K: camera_info; cam0: Kalibr camchain; model_type: "
        "camodocal)");
  }
  if (result.camera.width <= 0 || result.camera.height <= 0) {
    throw std::runtime_error("image size is " + std::to_string(result.camera.width) + " x " +
                             std::to_string(result.camera.height) + ", needs positive numbers");
  }
  makeCameraModel(result.camera);  // a calibration that is returned can be used
  return result;
}

}  // namespace

CalibrationFile readCalibrationFile(const std::string& path, int camera) {
  try {
    return parse(path, camera);
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

}  // namespace tet_line_tracker
