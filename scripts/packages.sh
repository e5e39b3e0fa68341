# Debian packages by purpose: build, run (what README and the demo without a display start), displays (what builds the
# displays of rviz), rviz, test, lint, benchmark, vio (vio_benchmark.sh), core (the core alone), fresh_root (test_core.sh
# --fresh-root, test_distributions.sh), libfuzzer (fuzz.sh --libfuzzer), coverage (coverage.sh), hosts (test_hosts.sh), arm64 and
# arm64_root (test_arm64.sh, on this machine and of its emulated one). Sourced by environment.sh.

packages_core=(cmake g++ libeigen3-dev libgtest-dev libopencv-dev libyaml-cpp-dev ninja-build)
packages_coverage=(gcovr)
packages_hosts=(iproute2)
packages_fresh_root=(debootstrap)
packages_libfuzzer=(clang libclang-rt-dev)
packages_arm64=(debian-archive-keyring g++-aarch64-linux-gnu qemu-user-static)
packages_arm64_root=(libc6-dev libeigen3-dev libgtest-dev libopencv-dev libstdc++6 libyaml-cpp-dev)

if [ -e /opt/ros/noetic/setup.bash ]; then
  # Ubuntu 20.04 with ROS Noetic from packages.ros.org.
  packages_build=(build-essential cmake ninja-build libboost-program-options-dev libeigen3-dev libopencv-contrib-dev
    libopencv-dev libyaml-cpp-dev ros-noetic-catkin ros-noetic-cv-bridge ros-noetic-diagnostic-updater
    ros-noetic-dynamic-reconfigure
    ros-noetic-geometry-msgs ros-noetic-image-transport ros-noetic-message-generation ros-noetic-nav-msgs ros-noetic-nodelet
    ros-noetic-pluginlib ros-noetic-rosbag ros-noetic-roscpp ros-noetic-sensor-msgs ros-noetic-std-msgs
    ros-noetic-std-srvs ros-noetic-tf2-msgs ros-noetic-tf2-ros ros-noetic-visualization-msgs)
  packages_run=(ros-noetic-diagnostic-aggregator
    ros-noetic-rosbash ros-noetic-roslaunch ros-noetic-rosnode ros-noetic-rosout ros-noetic-rosservice
    ros-noetic-rostopic)
  packages_displays=(qtbase5-dev ros-noetic-rviz)
  packages_rviz=("${packages_displays[@]}")
  packages_test=("${packages_displays[@]}" libgl1-mesa-dri libgtest-dev python3-matplotlib python3-yaml
    ros-noetic-roslaunch ros-noetic-rostest
    ros-noetic-rosunit xvfb)
  packages_lint=(clang-format clang-tidy doxygen python3-catkin-lint)
  packages_benchmark=(libbenchmark-dev)
  packages_plot=(python3-matplotlib)
  packages_vio=(libboost-filesystem-dev libceres-dev python3-numpy ros-noetic-message-filters ros-noetic-rosbag ros-noetic-tf)
else
  # Debian 12 packages ROS 1 itself.
  packages_build=(build-essential catkin cmake libboost-program-options-dev libcv-bridge-dev libdiagnostic-updater-dev
    libdynamic-reconfigure-config-init-mutex-dev
    libeigen3-dev libgeometry-msgs-dev libimage-transport-dev libnav-msgs-dev libnodelet-dev libnodeletlib-dev libopencv-contrib-dev
    libopencv-dev librosbag-dev libroscpp-dev libsensor-msgs-dev libstd-srvs-dev libtf2-msgs-dev libtf2-ros-dev
    libvisualization-msgs-dev libyaml-cpp-dev ninja-build pluginlib-dev ros-diagnostic-msgs ros-geometry-msgs
    ros-message-generation ros-nav-msgs ros-sensor-msgs ros-std-msgs ros-std-srvs ros-tf2-msgs ros-visualization-msgs)
  packages_run=(libdiagnostic-aggregator-dev libdiagnostic-aggregator-tools python3-dynamic-reconfigure
    libnodeletlib-tools python3-diagnostic-msgs python3-nav-msgs python3-rosbag python3-roslaunch python3-rosnode python3-rosservice
    python3-rostopic python3-sensor-msgs python3-std-srvs python3-tf2-msgs python3-visualization-msgs rosbash rosout tf2-tools)
  # The Qt of rviz, and what draws its icons.
  case $(. /etc/os-release && echo "$ID ${VERSION_ID:-}") in
    "debian 11" | "debian 12" | ubuntu*) packages_qt=(qtbase5-dev libqt5svg5) ;;
    *) packages_qt=(qt6-base-dev qt6-svg-plugins) ;;
  esac
  # librviz-dev of Debian 11 does not ask for all that it links.
  packages_displays=(libopengl-dev librviz-dev "${packages_qt[@]}")
  packages_rviz=("${packages_displays[@]}" libgl1-mesa-dri rviz)
  packages_test=("${packages_rviz[@]}" libgtest-dev librostest-dev python3-matplotlib python3-rostest
    python3-yaml xvfb)
  packages_lint=(catkin-lint clang-format clang-tidy doxygen)
  packages_benchmark=(libbenchmark-dev)
  packages_plot=(python3-matplotlib)
  packages_vio=(libboost-filesystem-dev libceres-dev libmessage-filters-dev libtf-dev python3-numpy python3-rosbag python3-rospy)
fi
