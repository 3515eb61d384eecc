# shellcheck shell=bash
# What the scripts of this folder share; sourced, not run.

set -euo pipefail

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
workspace=$repository/build/ws

# catkin and roslaunch need the distribution's Python; another one first on PATH (pyenv, conda) lacks their modules.
PATH=/usr/bin:/bin:$PATH

# Caches and logs belong below build/ too, not into the home of whoever runs a script.
export ROS_HOME=$repository/build/ros_home MPLCONFIGDIR=$repository/build/matplotlib

# source_workspace: makes rosrun and roslaunch know the built package.
source_workspace() {
  mkdir -p "$ROS_HOME"
  set +u  # catkin's script reads variables that may be unset
  # shellcheck disable=SC1091
  source "$workspace/devel/setup.bash"
  set -u
}

say() { printf '\n== %s\n' "$*"; }

fail() {
  printf '[ERROR] %s\n' "$*" >&2
  exit 1
}

# ensure_packages <package>...: installs those that are missing; touches nothing, not even the network, when none is.
ensure_packages() {
  local package missing=() as_root=()
  command -v dpkg-query > /dev/null ||
    fail "This is not Debian or a relative of it; install the packages named in package.xml and use the repository as a catkin package."
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2> /dev/null) == installed* ]] || missing+=("$package")
  done
  ((${#missing[@]} == 0)) && return

  if ((EUID != 0)); then
    as_root=(sudo)
    if ! command -v sudo > /dev/null || { [[ ! -t 0 ]] && ! sudo -n true 2> /dev/null; }; then
      fail "Packages are missing and only root may install them; run: apt-get install ${missing[*]}"
    fi
  fi
  say "Installing ${missing[*]}"
  "${as_root[@]}" apt-get update -q || say "apt-get update failed; trying with the package lists at hand"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -q --yes --no-install-recommends -o DPkg::Lock::Timeout=300 "${missing[@]}" ||
    fail "apt-get could not install ${missing[*]}; see its messages above."
}

# What the core needs, what ROS and the programs, which need it, add, and what the tests add.
core_packages=(cmake g++ make libapriltag-dev libboost-program-options-dev libeigen3-dev libopencv-dev libsuitesparse-dev
  libyaml-cpp-dev)
ros_packages=(catkin libcairo2-dev libcv-bridge-dev libdiagnostic-msgs-dev librosbag-dev libroscpp-dev libsensor-msgs-dev
  libstd-msgs-dev libstd-srvs-dev pkg-config python3-matplotlib python3-rosbag python3-roslaunch ros-environment rosbash)
test_packages=(libceres-dev libgtest-dev poppler-utils python3-diagnostic-msgs python3-numpy python3-rosparam python3-rosservice
  python3-rospy python3-rostest python3-sensor-msgs python3-std-msgs python3-std-srvs python3-yaml)
# shellcheck disable=SC2034
all_packages=("${core_packages[@]}" "${ros_packages[@]}" "${test_packages[@]}")

# CMake options of every build: warnings are errors, and ccache where it is installed anyway; it cannot use precompiled headers.
cmake_options=(-DTARTAN_CALIB_WERROR=ON)
if command -v ccache > /dev/null; then
  cmake_options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
else
  cmake_options+=(-DTARTAN_CALIB_PRECOMPILED_HEADERS=ON)
fi
