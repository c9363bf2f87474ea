#!/usr/bin/python3
"""Reads the bags of a recording with Debian's python3-rosbag, as any ROS tool would: read_bag.py FOLDER LIDAR...

Exit 77 where python3-rosbag is not installed. LIDAR: the frames of the planar lidars, by their places."""
import math
import pathlib
import sys

try:
    import genpy
    import rosbag
except ImportError:
    sys.exit(77)


def transform(message):
    move, turn = message.transform.translation, message.transform.rotation
    return move.x, move.y, 2.0 * math.atan2(turn.z, turn.w)


def composed(a, b):
    return (a[0] + math.cos(a[2]) * b[0] - math.sin(a[2]) * b[1],
            a[1] + math.sin(a[2]) * b[0] + math.cos(a[2]) * b[1], a[2] + b[2])


def check(bag, lidars):
    span_s = bag.get_end_time() - bag.get_start_time()
    assert 0.5 < span_s < 60.0, f"the bag spans {span_s} s"
    types = {topic: info.msg_type for topic, info in bag.get_type_and_topic_info().topics.items()}
    expected = {"/cmd_vel": "geometry_msgs/Twist", "/odom": "nav_msgs/Odometry", "/tf": "tf2_msgs/TFMessage",
                "/tf_static": "tf2_msgs/TFMessage", "/pose": "geometry_msgs/PoseWithCovarianceStamped"}
    expected.update({"/scan" if i == 0 else f"/scan/{i}": "sensor_msgs/LaserScan" for i in range(len(lidars))})
    for topic, kind in expected.items():
        assert types.get(topic) == kind, f"{topic} is {types.get(topic)}"
    counts, frames, poses, at = {}, {}, {}, 0
    begin = genpy.Time.from_sec(bag.get_start_time())
    for topic, message, when in bag.read_messages():
        counts[topic] = counts.get(topic, 0) + 1
        assert when >= begin and when.to_sec() > 900.0, f"{topic} at {when.to_sec()}"
        if hasattr(message, "header"):
            assert abs((message.header.stamp - when).to_sec()) < 1.0, f"{topic}: {message.header.stamp.to_sec()}"
        if topic in ("/tf", "/tf_static"):
            for one in message.transforms:
                assert one.header.stamp.to_sec() > 900.0, one
                frames[one.child_frame_id] = (one.header.frame_id, transform(one), one.transform.translation.z)
        if topic == "/tf" and frames.get("odom"):
            poses[message.transforms[0].header.stamp.to_nsec()] = composed(frames["odom"][1], frames["base_link"][1])
        if topic.startswith("/scan"):
            place = int(topic[6:] or 0)
            assert message.header.frame_id == lidars[place], message.header.frame_id
            assert len(message.ranges) == round((message.angle_max - message.angle_min) / message.angle_increment) + 1
        if topic == "/pose" and message.header.stamp.to_nsec() in poses:
            told, place = poses[message.header.stamp.to_nsec()], message.pose.pose.position
            assert math.hypot(told[0] - place.x, told[1] - place.y) < 0.05, (told, place)
            at += 1
    assert frames["base_link"][0] == "odom" and frames["odom"][0] == "map", frames
    for lidar in lidars:
        assert frames[lidar][0] == "base_link" and frames[lidar][2] > 0.0, frames[lidar]
    assert counts["/tf_static"] == 1, "each bag is opened alone"
    assert at > 10, f"{at} poses were compared with /tf"
    return counts


def main():
    bags = sorted(pathlib.Path(sys.argv[1]).glob("*.bag"))
    assert bags, "there is no bag"
    for file in bags:
        with rosbag.Bag(str(file)) as bag:
            print(file.name, check(bag, sys.argv[2:]))


main()
