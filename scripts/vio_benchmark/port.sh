# Sourced by vio_benchmark.sh: the copy of PL-VINS's sources, and the mechanical edits that today's libraries need.

# What of PL-VINS is needed; its other packages are for displays and loops.
pl_vins_parts=(camera_model feature_tracker vins_estimator)

# requirePlVins CHECKOUT: ends the script when there is none.
requirePlVins() {
  local part
  [ -d "$1" ] || fail "there is no folder $1: clone PL-VINS and give its folder"
  for part in "${pl_vins_parts[@]}"; do
    [ -d "$1/$part/src" ] || fail "$1 is no checkout of PL-VINS: it has no folder $part/src"
  done
  [ -f "$1/feature_tracker/src/linefeature_tracker_node.cpp" ] && [ -f "$1/vins_estimator/src/estimator_node.cpp" ] ||
    fail "$1 is no checkout of PL-VINS: linefeature_tracker_node.cpp or estimator_node.cpp is missing (VINS-Mono?)"
}

# stampOf CHECKOUT: changes when its sources or our edits do.
stampOf() {
  {
    (cd "$1" && find "${pl_vins_parts[@]}" -name '*.[ch]*' -type f -print0 | sort -z | xargs -0 cat)
    cat scripts/vio_benchmark/port.sh scripts/vio_benchmark/CMakeLists.txt
  } | sha256sum | cut -d ' ' -f 1
}

# copySources CHECKOUT COPY: copies and edits. The checkout stays as it is.
copySources() {
  rm -rf "$2"
  mkdir -p "$2"
  local part
  for part in "${pl_vins_parts[@]}"; do cp -r "$1/$part" "$2/"; done
  # Constants and headers that OpenCV 4 has no more.
  find "$2" \( -name '*.cpp' -o -name '*.cc' -o -name '*.h' -o -name '*.hpp' \) -print0 | xargs -0 sed -i -E \
    -e 's/\bCV_(GRAY2RGB|GRAY2BGR|RGB2GRAY|BGR2GRAY)\b/cv::COLOR_\1/g' \
    -e 's/\bCV_(INTER_LINEAR)\b/cv::\1/g' \
    -e 's/\bCV_AA\b/cv::LINE_AA/g' \
    -e 's/\bCV_(WINDOW_NORMAL)\b/cv::\1/g' \
    -e 's/\bCV_(MAJOR|MINOR)_VERSION\b/CV_VERSION_\1/g' \
    -e 's,<opencv/(cv|highgui)\.h>,<opencv2/opencv.hpp>,'
  # Files in folders of the authors: the trajectory is taken from the topic.
  find "$2" -name '*.cpp' -print0 | xargs -0 sed -i -E 's,"/[A-Za-z][^"]*\.txt","/dev/null",'
}
