"""`pantin.ray_convert` on a Ray cluster of two nodes with one CPU each, on this machine, between buckets of an S3 server (moto).

    python cluster_trial.py FOLDER-OF-BVH-FILES --clips 2000

cuts clips of 1 to 2 s from the files, converts them in one process, then on the cluster, then on the cluster while a worker and later a whole node
are killed, and compares all clips. `test_cluster.py` runs a short form. Needs ray, fsspec, pyarrow, s3fs, moto[server] and psutil.
"""

import argparse
import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

import pantin

OPTIONS = {"max_error_cm": 0.5, "effort": "fast"}


def cut(sources, folder, count):
    """Writes `count` BVH files of 1 to 2 s, cut from files, to folders of the files' names; returns their seconds of motion."""
    texts = [(path.stem, path.read_text().splitlines()) for path in sources]
    total = 0.0
    for number in range(count):
        name, lines = texts[number % len(texts)]
        row = next(index for index, line in enumerate(lines) if line.strip().startswith("Frame Time"))
        step = float(lines[row].split(":")[1])
        frames = [line for line in lines[row + 1 :] if line.strip()]
        turn = number // len(texts)
        length = min(round((1 + turn % 11 / 10) / step), len(frames))
        # Steps of a prime number of frames: no two cuts of a file are equal before they meet its end.
        first = turn * 37 % (len(frames) - length + 1)
        path = folder / name / f"{number:04}.bvh"
        path.parent.mkdir(parents=True, exist_ok=True)
        head = [*lines[: row - 1], f"Frames: {length}", lines[row]]
        path.write_text("\n".join(head + frames[first : first + length]) + "\n")
        total += length * step
    return total


def one_process(folder):
    """The clips' bytes by the motions' names without ending, and the CPU seconds that they took."""
    before = time.process_time()
    clips = {}
    for path in sorted(folder.rglob("*.bvh")):
        with contextlib.suppress(pantin.PantinError):
            clips[path.relative_to(folder).with_suffix("").as_posix()] = bytes(pantin.convert(path, jobs=1, **OPTIONS))
    return clips, time.process_time() - before


@contextlib.contextmanager
def s3_server():
    """Runs moto's server; yields the storage options that open it."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "moto.server", "-H", "127.0.0.1", "-p", str(port)]
    server = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    url = f"http://127.0.0.1:{port}"
    try:
        deadline = time.monotonic() + 60
        while True:
            try:
                urllib.request.urlopen(f"{url}/moto-api/", timeout=5).close()
                break
            except (urllib.error.URLError, OSError):
                if time.monotonic() > deadline or server.poll() is not None:
                    raise
                time.sleep(0.2)
        yield {"key": "test", "secret": "test", "endpoint_url": url}
    finally:
        server.terminate()
        server.wait()


@contextlib.contextmanager
def two_nodes():
    """A Ray cluster of two nodes with one CPU each, to which this process is connected."""
    # Ray's workers have the niceness 15 otherwise: on a machine with other work, one process and a cluster could not be compared.
    os.environ.update(RAY_USAGE_STATS_ENABLED="0", RAY_worker_niceness="0")
    import ray
    from ray.cluster_utils import Cluster

    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    try:
        # Before the other node is there: a process whose own node dies ends with it.
        ray.init(address=cluster.address, log_to_driver=False, logging_level="error")
        cluster.add_node(num_cpus=1)
        cluster.wait_for_nodes()
        yield cluster
    finally:
        ray.shutdown()
        cluster.shutdown()


def raylet(node):
    return node.all_processes["raylet"][0].process.pid


def workers(node):
    """The processes of a node that convert."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            parent = int(folder.joinpath("stat").read_text().rpartition(")")[2].split()[1])
            if parent == raylet(node) and folder.joinpath("cmdline").read_bytes().startswith(b"ray::pantin.convert"):
                found.append(int(folder.name))
    return found


def kill_worker(cluster):
    """Kills a process in the middle of a conversion."""
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        for pid in [pid for node in cluster.list_all_nodes() for pid in workers(node)]:
            os.kill(pid, signal.SIGKILL)
            return pid
        time.sleep(0.005)
    raise TimeoutError("no worker converts")


def cpu_seconds(cluster):
    """CPU seconds of all processes of the cluster that live, Ray's own included; not of the S3 server."""
    import psutil

    roots = [info[0].process.pid for node in cluster.list_all_nodes() for info in node.all_processes.values()]
    processes = {process.pid: process for root in roots for process in [psutil.Process(root), *psutil.Process(root).children(recursive=True)]}
    total = 0.0
    for process in processes.values():
        with contextlib.suppress(psutil.Error):
            times = process.cpu_times()
            total += times.user + times.system
    return total


def clips_in(url, storage):
    """The clips in a bucket, by their names without ending."""
    import s3fs

    fs = s3fs.S3FileSystem(**storage, use_listings_cache=False)
    root = url.removeprefix("s3://")
    found = [path for path in fs.find(root) if path.endswith(".ptn")]
    return {path[len(root) + 1 : -4]: data for path, data in fs.cat(found).items()} if found else {}


def upload(folder, url, storage):
    import s3fs

    fs = s3fs.S3FileSystem(**storage, use_listings_cache=False)
    fs.mkdir(url.removeprefix("s3://").split("/")[0])
    fs.put(f"{folder}/", url, recursive=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("motions", type=Path)
    parser.add_argument("--clips", type=int, default=2000)
    arguments = parser.parse_args()
    sources = sorted(arguments.motions.glob("*.bvh"))

    def say(what, **facts):
        print(json.dumps({"run": what, "load": round(os.getloadavg()[0], 1), **facts}), flush=True)

    with tempfile.TemporaryDirectory() as place, s3_server() as storage:
        folder = Path(place, "captures")
        motion = cut(sources, folder, arguments.clips)
        upload(folder, "s3://motions/captures", storage)
        begun = time.monotonic()
        expected, cpu = one_process(folder)
        wall = time.monotonic() - begun
        say("one process", clips=len(expected), motion_s=round(motion), wall_s=round(wall, 1), cpu_s=round(cpu, 1))

        with two_nodes() as cluster:
            for what, source, target in [
                ("two nodes, folders", str(folder), f"{place}/clips"),
                ("two nodes, S3", "s3://motions/captures", "s3://motions/clips"),
                ("two nodes, S3, again", "s3://motions/captures", "s3://motions/clips"),
            ]:
                before, begun = cpu_seconds(cluster) + time.process_time(), time.monotonic()
                table = pantin.ray_convert(source, target, storage_options=storage, **OPTIONS)
                wall, cpu = time.monotonic() - begun, cpu_seconds(cluster) + time.process_time() - before
                if target.startswith("s3://"):
                    found = clips_in(target, storage)
                else:
                    found = {path.relative_to(target).with_suffix("").as_posix(): path.read_bytes() for path in Path(target).rglob("*.ptn")}
                summary(say, what, table, expected, found, wall, cpu)

        kill(say, expected, storage)


def kill(say, expected, storage):
    """Kills a worker at a fifth of the motions, and at three fifths the node that this process is not connected to."""
    killed = []
    with two_nodes() as cluster:

        def progress(part):
            if part >= 0.2 and not killed:
                killed.append(f"worker {kill_worker(cluster)}")
            if part >= 0.6 and len(killed) == 1:
                cluster.remove_node(cluster.list_all_nodes()[-1], allow_graceful=False)
                killed.append("node")

        begun = time.monotonic()
        table = pantin.ray_convert("s3://motions/captures", "s3://motions/killed", storage_options=storage, progress=progress, **OPTIONS)
        found = clips_in("s3://motions/killed", storage)
        summary(say, f"two nodes, S3, killed: {killed}", table, expected, found, time.monotonic() - begun, None)


def summary(say, what, table, expected, found, wall, cpu):
    rows = table.to_pylist()
    say(
        what,
        rows=len(rows),
        clips=len(found),
        same_bytes=found == expected,
        refused=sum(row["refused"] is not None for row in rows),
        up_to_date=sum(row["up_to_date"] for row in rows),
        by_node=sorted(sum(row["node"] == node for row in rows) for node in {row["node"] for row in rows}),
        wall_s=round(wall, 1),
        cpu_s=None if cpu is None else round(cpu, 1),
    )


if __name__ == "__main__":
    main()
