# Debian packages by purpose: build, run (what README and the demo without a display start), displays (what builds the
# displays of rviz), rviz, test, lint, benchmark, core (the core alone), fresh_root (test_core.sh --fresh-root). Sourced by
# environment.sh.

packages_core=(cmake g++ libeigen3-dev libgtest-dev libopencv-dev libyaml-cpp-dev ninja-build)
packages_fresh_root=(debootstrap)

if [ -e /opt/ros/noetic/setup.bash ]; then
  # Ubuntu 20.04 with ROS Noetic from packages.ros.org.
  packages_build=(build-essential cmake ninja-build libboost-program-options-dev libeigen3-dev libopencv-contrib-dev
    libopencv-dev libyaml-cpp-dev ros-noetic-catkin ros-noetic-cv-bridge ros-noetic-diagnostic-updater
    ros-noetic-geometry-msgs ros-noetic-image-transport ros-noetic-message-generation ros-noetic-nav-msgs ros-noetic-nodelet
    ros-noetic-pluginlib ros-noetic-rosbag ros-noetic-roscpp ros-noetic-sensor-msgs ros-noetic-std-msgs
    ros-noetic-std-srvs ros-noetic-tf2-msgs ros-noetic-tf2-ros ros-noetic-visualization-msgs)
  packages_run=(ros-noetic-rosbash ros-noetic-roslaunch ros-noetic-rosnode ros-noetic-rosout ros-noetic-rosservice
    ros-noetic-rostopic)
  packages_displays=(qtbase5-dev ros-noetic-rviz)
  packages_rviz=("${packages_displays[@]}")
  packages_test=("${packages_displays[@]}" libgl1-mesa-dri libgtest-dev python3-yaml ros-noetic-roslaunch ros-noetic-rostest
    ros-noetic-rosunit xvfb)
  packages_lint=(clang-format clang-tidy python3-catkin-lint)
  packages_benchmark=(libbenchmark-dev)
  packages_plot=(python3-matplotlib)
else
  # Debian 12 packages ROS 1 itself.
  packages_build=(build-essential catkin cmake libboost-program-options-dev libcv-bridge-dev libdiagnostic-updater-dev
    libeigen3-dev libgeometry-msgs-dev libimage-transport-dev libnav-msgs-dev libnodelet-dev libnodeletlib-dev libopencv-contrib-dev
    libopencv-dev librosbag-dev libroscpp-dev libsensor-msgs-dev libstd-srvs-dev libtf2-msgs-dev libtf2-ros-dev
    libvisualization-msgs-dev libyaml-cpp-dev ninja-build pluginlib-dev ros-diagnostic-msgs ros-geometry-msgs
    ros-message-generation ros-nav-msgs ros-sensor-msgs ros-std-msgs ros-std-srvs ros-tf2-msgs ros-visualization-msgs)
  packages_run=(libnodeletlib-tools python3-diagnostic-msgs python3-nav-msgs python3-rosbag python3-roslaunch python3-rosnode python3-rosservice
    python3-rostopic python3-sensor-msgs python3-std-srvs python3-tf2-msgs python3-visualization-msgs rosbash rosout tf2-tools)
  packages_displays=(librviz-dev qtbase5-dev)
  packages_rviz=("${packages_displays[@]}" libgl1-mesa-dri rviz)
  packages_test=("${packages_rviz[@]}" libgtest-dev librostest-dev python3-rostest python3-yaml xvfb)
  packages_lint=(catkin-lint clang-format clang-tidy)
  packages_benchmark=(libbenchmark-dev)
  packages_plot=(python3-matplotlib)
fi
