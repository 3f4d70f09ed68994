"""Fetching by address and checksum, from a server on this machine."""

import hashlib
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from dentscope.core.errors import InputError
from dentscope.recordings.fetch import fetch_sources, read_catalogue

SHIPPED = Path(__file__).parents[3] / "data" / "recordings" / "fetch.toml"


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *args):
        pass


@pytest.fixture
def server(tmp_path):
    folder = tmp_path / "served"
    (folder / "a b").mkdir(parents=True)
    (folder / "a b" / "x, 1.csv").write_bytes(b"1,2\n")
    http = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    thread = threading.Thread(target=http.serve_forever, daemon=True)
    thread.start()
    yield f"http://127.0.0.1:{http.server_port}/"
    http.shutdown()
    thread.join()
    http.server_close()


def catalogue(tmp_path, base, sha, path="a b/x, 1.csv"):
    file = tmp_path / "fetch.toml"
    file.write_text(
        f'[[source]]\nname = "one"\nlicence = "none stated"\nbase = "{base}"\n'
        f'[[source.files]]\npath = "{path}"\nto = "sub/x.csv"\nsha256 = "{sha}"\n'
    )
    return read_catalogue(file)


def test_file_arrives_once_and_is_kept(tmp_path, server):
    found = catalogue(tmp_path, server, hashlib.sha256(b"1,2\n").hexdigest())
    (got,) = fetch_sources(found, tmp_path / "out", [])
    assert got.files[0].read_bytes() == b"1,2\n"
    before = got.files[0].stat().st_mtime_ns
    (again,) = fetch_sources(found, tmp_path / "out", ["one"])
    assert again.files[0].stat().st_mtime_ns == before


def test_other_checksum_missing_file_and_unknown_name_are_lines(tmp_path, server):
    wrong = catalogue(tmp_path, server, "0" * 64)
    with pytest.raises(InputError, match="another checksum"):
        list(fetch_sources(wrong, tmp_path / "out", []))
    assert not (tmp_path / "out" / "one" / "raw" / "sub" / "x.csv").exists()
    gone = catalogue(tmp_path, server, "0" * 64, path="nothing.csv")
    with pytest.raises(InputError, match="cannot be fetched"):
        list(fetch_sources(gone, tmp_path / "out", []))
    with pytest.raises(InputError, match=r"no source 'two'.*one"):
        list(fetch_sources(gone, tmp_path / "out", ["two"]))


def test_a_path_that_leaves_the_folder_is_refused(tmp_path):
    file = tmp_path / "fetch.toml"
    file.write_text(
        '[[source]]\nname = "one"\nlicence = ""\nbase = "https://example.org/"\n'
        f'[[source.files]]\npath = "x"\nto = "../x"\nsha256 = "{"0" * 64}"\n'
    )
    with pytest.raises(InputError, match="inside the source's folder"):
        read_catalogue(file)


def test_shipped_list_is_sound_and_pinned_to_commits():
    sources = read_catalogue(SHIPPED).source
    assert len(sources) >= 4
    for source in sources:
        assert any(len(part) == 40 for part in source.base.split("/"))
