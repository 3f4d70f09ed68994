"""What meshing leaves of the process: gmsh alone would end it at a broken pipe."""

from made_processes import python

BROKEN = """
import os, threading
from dentscope.fem.mesh.bodies import _session

def mesh():
    with _session():
        pass

if {thread}:
    one = threading.Thread(target=mesh)
    one.start()
    one.join()
else:
    mesh()
reads, writes = os.pipe()
os.close(reads)
try:
    os.write(writes, b"1")
except BrokenPipeError:
    print("told")
"""


def test_a_broken_pipe_after_meshing_is_an_error_and_not_the_end():
    for thread in (False, True):
        answer = python("-c", BROKEN.format(thread=thread))
        assert (answer.returncode, answer.stdout) == (0, "told\n"), (thread, answer)
