#include "tartan_calibrate/tartan_flags.h"

namespace tartan_calib::apps {

std::string tartanHelpText() {
  return R"(Calibrates cameras as calibrate_cameras does, with the flags and file names of TartanCalib's tartan_calibrate.

  rosrun tartan_calib tartan_calibrate --bag rig.bag --target april_6x6.yaml --topics /cam0/image_raw --models ds-none \
      --save_dir results/ --log_dest rig

writes results/rig0-camchain.yaml and rig0-results-cam.txt (detection alone), and the final rig1-camchain.yaml,
rig1-results-cam.txt, rig1-calibration.yaml and report.

Files
  --save_dir DIR            folder of the results, made where it is missing (/data/)
  --log_dest NAME           what their names begin with (log)
  --debug_image_dir DIR     folder of the pictures of --debug-modes (the one of --save_dir)

Where corners are looked for
  --projections P [P ...]   cornerpredictor: at their predictions, in rounds, with calibrate_cameras' tests (default)
                            pinhole, homography, cube: in virtual views remapped with the model; none: only without a model
  --correction-threshold V  filter corners by quadrilaterals, as the paper does, within sqrt(V) px (calibrate_cameras takes px)
  --fovs, --poses, --resolutions
                            of the virtual views, two rows with one value per projection: see calibrate_cameras --help

Pictures, as PNG files
  --debug-modes M [M ...]   originalprojection: images with corners, red those of detection, green those found later
                            pinholeprojection: a cube's faces in a cross; individualprojections: every virtual view
                            reprojectionpoints: all corners; targetpointcloud: the board's places before the camera
                            pointcloudprojection: where the virtual views look

All flags of calibrate_cameras work too; see calibrate_cameras --help. Flags of TartanCalib that mean nothing to this solver are
accepted, and the terminal says why they have no effect.
)";
}

}  // namespace tartan_calib::apps
