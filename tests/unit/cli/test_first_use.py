"""A command that compiles for a minute says so, once."""

from dentscope.cli.shared.terminal import tell_first_use


def test_it_is_said_until_the_code_is_there(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    tell_first_use()
    assert capsys.readouterr().err.startswith("first use: compiling")
    folder = tmp_path / "walk_0"
    folder.mkdir()
    (folder / "compiled._impacts-131.py311.nbi").touch()
    tell_first_use()
    assert capsys.readouterr().err == ""


def test_the_name_is_that_of_the_compiled_integrator() -> None:
    from dentscope.dynamics.stepping import compiled

    assert compiled.__name__.endswith(".compiled")
    assert compiled._impacts.py_func.__name__ == "_impacts"
