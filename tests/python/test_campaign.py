"""Campaigns as frames."""

import shutil
import sqlite3
import subprocess
import sys

import downwash
import pytest


def test_frames_hold_what_the_report_counts(results, json_of):
    campaign = downwash.Campaign(results)
    assert campaign.settings["campaign"] == "small"
    runs = campaign.runs()
    assert list(runs.columns[:7]) == ["run", "problem", "objective", "variant", "algorithm", "margin_m", "seed"]
    assert len(runs) == 4
    assert runs["solved"].dtype == bool
    report = json_of("bench", "report", results)
    for total in report["totals"]:
        rows = runs[runs["variant"] == total["variant"]]
        assert len(rows) == total["solved"]["attempts"] == 2
        assert int(rows["solved"].sum()) == total["solved"]["hits"]
        assert int((rows["solved"] & (rows["outcome"] == "ok")).sum()) == total["held"]["hits"]
    assert set(campaign.world_flights()["worlds"]) == {3}
    assert (campaign.progress().groupby("run")["time_s"].diff().dropna() >= 0).all()
    assert len(campaign.certificates()) <= 4
    machines = campaign.machines()
    assert len(machines) == 4 and (machines["host"] != "").all() and (machines["load"] >= 0).all()
    assert (campaign.rejections()["edges"] >= 0).all()


def test_a_folder_may_have_any_name(results, tmp_path):
    odd = tmp_path / "run #2 100%41?"
    shutil.copytree(results, odd)
    assert len(downwash.Campaign(odd).runs()) == 4


def test_other_folders_are_no_campaign(tmp_path):
    with pytest.raises(downwash.InputError, match="no such file"):
        downwash.Campaign(tmp_path)
    database = sqlite3.connect(tmp_path / "campaign.db")
    database.execute("CREATE TABLE a (b)")
    database.close()
    with pytest.raises(downwash.InputError, match="holds no results of a campaign"):
        downwash.Campaign(tmp_path)
    (tmp_path / "campaign.db").write_text("no database" * 100)
    with pytest.raises(downwash.InputError, match="cannot be read"):
        downwash.Campaign(tmp_path)


def test_the_package_needs_neither_pandas_nor_matplotlib(results):
    script = """
import sys
sys.modules["pandas"] = sys.modules["matplotlib"] = None
import downwash, downwash.figures
downwash.Campaign(sys.argv[1])
"""
    subprocess.run([sys.executable, "-c", script, str(results)], check=True)
