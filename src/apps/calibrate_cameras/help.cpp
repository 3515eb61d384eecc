#include "calibrate_cameras/arguments.h"

namespace tartan_calib::apps {
namespace {

constexpr const char* kHelp = R"(Calibrates cameras, and where they sit on a rig, from a recording of a calibration board.

  rosrun tartan_calib calibrate_cameras --bag rig.bag --target april_6x6.yaml \
      --topics /cam0/image_raw /cam1/image_raw --models ds-none ds-none

writes rig-camchain.yaml, rig-results-cam.txt, rig-calibration.yaml and a report, rig-report-cam.pdf and .html, beside the bag.

What to calibrate
  --bag B                   ROS 1 bag, or folder with cam0/<stamp in ns>.png (jpg, bmp, pgm)
  --topics T [T ...]        image topics; the first is cam0. Of a folder: /cam0/image_raw ...
  --models M [M ...]        one per topic: pinhole-none, pinhole-radtan, pinhole-equi, pinhole-fov,
                            omni-none, omni-radtan, eucm-none, ds-none
  --target F                board: YAML as Kalibr's (aprilgrid, checkerboard, circlegrid)
  --rig F                   YAML file with flags, for all recordings of a rig: config/rigs/example_stereo.yaml
  --corners F               calibrate from a file of --export-corners instead of images

Which images
  --bag-from-to A B         only those from A to B seconds after the topic's first
  --bag-freq HZ             at most so many per second
  --approx-sync S           largest difference of stamps in one view of a rig, seconds (0.02)

Start from a calibration
  --init F                  camchain to start from; --models and --topics may then be left out
  --fix WHAT                intrinsics, extrinsics or camN: keeps them as in --init; may be repeated

Corners
  --min-tags N              AprilGrid: images with fewer tags wait for the rounds (1 more than the board's longer side has)
  --min-border-distance PX  tags closer to the edge of the image are left to the rounds (4)
  --max-rounds N            go through the images again with the calibrated model and look where it says corners are, at
                            most so often (5); 0: only the tags that are detected without a model, as Kalibr
  --corner-filter F         what says that a predicted corner is there: image (X-corner, payload, neighbours; the default)
                            or quads (a quadrilateral on the predicted tag, as TartanCalib: finds fewer)
  --correction-threshold X  quads: largest distance of its corners from the tag's, in pixels (1.41)
  --projections P [P ...]   also detect in virtual views, remapped with the model: cube (five faces), homography (rectified
                            on the predicted board), pinhole (one view for each, described by a column of the next three);
                            may be repeated
  --fovs H .. --fovs V ..   degrees of each view (90 90)
  --poses X .. --poses Z .. degrees about x, then z (90 0: towards -y; 0 0: ahead)
  --resolutions H .. --resolutions W ..
                            pixels of each view (1000 1000)
  --refinement R            of corners in the rounds: symmetry (default; through the model), adaptive (TartanCalib's windows)
                            or fixed (Kalibr's)
  --symmetry-window W       symmetry: half-width, 1 reaches as far as the board is symmetric about a corner (0.9); the paper's
                            on Kalibr's board is 1.5. On an AprilGrid more than 1 takes in payload and fails
  --window-scale S  --min-resize-window-size PX  --max-resize-window-size PX
                            adaptive: half-width as a share of the distance to the nearest corner (0.4), between (2) and (8)

Solver
  --estimate-board-warp     also fit the curvature of the board
  --estimate-pupil-shift    also fit how the lens' entrance pupil moves: for boards within decimetres of a wide lens
  --no-outliers-removal     keep all corners
  --no-final-filtering      no last pass of outlier removal over all views
  --min-views-outlier N     remove outliers only with more than N views per camera (20)
  --use-blakezisserman      robust weights instead of plain least squares
  --linear-solver L         schur, sparse or auto (auto): same result, different speed
  --threads N               0 uses all cores (0); the result does not depend on it

Output
  --export-poses            also write <bag>-poses-cam0.csv
  --export-corners          also write <bag>-corners.csv
  --no-report               no report: saves its time, and the verdict that goes with it
  --dont-show-report        do not open the report (done only at a terminal with a display)
  --verbose                 also print how long each step took
  -h, --help                this text

Accepted for Kalibr's sake, without effect: a batch solver uses every view, in any order, and opens no windows
  --qr-tol X  --mi-tol X  --no-shuffle  --plot  --plot-outliers  --show-extraction

Flags may be cut short while they stay unambiguous. Environment: KALIBR_MANUAL_FOCAL_LENGTH_INIT, a focal length of 10 to
1000000 pixels, helps the start where nothing else does. Exit code: 0 with a result, 1 without, 2 for a wrong command line,
130 after Ctrl-C.
)";

}  // namespace

std::string helpText() { return kHelp; }

}  // namespace tartan_calib::apps
