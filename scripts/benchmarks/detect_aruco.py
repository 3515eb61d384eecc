#!/usr/bin/python3
"""What OpenCV's ArUco detector, told of two border cells, finds of an AprilGrid in a bag of mono8 images, as a corner file.

  detect_aruco.py recording.bag target.yaml corners.csv

Prints the processor time that detection took on one thread: median of a frame [ms] and sum [s].
"""

import csv
import statistics
import sys
import time

import cv2
import numpy as np
import rosbag
import yaml

TOPIC = "/cam0/image_raw"
HEADER = ["camera", "stamp_ns", "corner_id", "u_px", "v_px", "cov_uu", "cov_uv", "cov_vv", "used"]
FAMILIES = {"t36h11": cv2.aruco.DICT_APRILTAG_36H11}


def images(bag_path):
    """(stamp, grey image) of each message; only mono8 is understood, as simulate writes it."""
    with rosbag.Bag(str(bag_path)) as bag:
        for _, message, _ in bag.read_messages(TOPIC):
            gray = np.frombuffer(message.data, np.uint8).reshape(message.height, message.step)[:, :message.width]
            yield message.header.stamp.to_nsec(), gray


def parameters(border_cells):
    result = cv2.aruco.DetectorParameters_create()
    result.markerBorderBits = border_cells
    result.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    return result


def corner_ids(target, tag):
    """In the order of OpenCV's corners, clockwise from what it takes for the top left: its pictures of AprilTags are turned by
    180 degrees against Kalibr's, so that is the bottom right."""
    row, col = divmod(tag, target["tagCols"])
    left_bottom = 2 * row * 2 * target["tagCols"] + 2 * col
    up = 2 * target["tagCols"]
    return [left_bottom + 1, left_bottom, left_bottom + up, left_bottom + up + 1]


def main():
    bag_path, target_path, output_path = sys.argv[1:]
    cv2.setNumThreads(1)
    with open(target_path) as file:
        target = yaml.safe_load(file)
    family = cv2.aruco.Dictionary_get(FAMILIES[target.get("tagFamily", "t36h11")])
    options = parameters(target.get("tagBorder", 2))
    num_tags = target["tagRows"] * target["tagCols"]
    rows, times_s = [], []
    for stamp_ns, gray in images(bag_path):
        start = time.process_time()
        quads, tags, _ = cv2.aruco.detectMarkers(gray, family, parameters=options)
        times_s.append(time.process_time() - start)
        found = {tag - target.get("codeOffset", 0): quad[0] for tag, quad in zip([] if tags is None else tags.ravel(), quads)}
        corners = [(corner, px) for tag, quad in found.items() if 0 <= tag < num_tags
                   for corner, px in zip(corner_ids(target, int(tag)), quad)]
        rows += [[0, stamp_ns, corner, *px, "", "", "", 1] for corner, px in sorted(corners, key=lambda pair: pair[0])]
    with open(output_path, "w", newline="") as file:
        file.write(f"# cam0 {gray.shape[1]} {gray.shape[0]} {TOPIC}\n")
        csv.writer(file, lineterminator="\n").writerows([HEADER, *rows])
    print(f"median {1e3 * statistics.median(times_s):.3f} ms\nsum {sum(times_s):.4f} s")


if __name__ == "__main__":
    main()
