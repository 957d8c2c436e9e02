"""Chromium without a window, and what it noticed."""

import base64
import json
import os
import tempfile

from selenium import webdriver
from selenium.webdriver.chrome.service import Service

# Of a browser's own start-up, not of the page.
OWN_SCHEMES = ("file:", "data:", "blob:", "chrome:", "devtools:", "about:", "chrome-extension:")


class Browser:
    def __init__(self, width=1400, height=900, arguments=()):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        options = webdriver.ChromeOptions()
        options.binary_location = os.environ.get("CHROMIUM", "/usr/bin/chromium")
        for argument in ("--headless=new", "--hide-scrollbars", "--force-device-scale-factor=1",
                         "--disable-background-networking", "--disable-component-update", "--no-first-run",
                         f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}", *arguments):
            options.add_argument(argument)
        if os.geteuid() == 0:
            options.add_argument("--no-sandbox")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        service = Service(os.environ.get("CHROMEDRIVER", "/usr/bin/chromedriver"))
        self.driver = webdriver.Chrome(service=service, options=options)
        self.driver.set_script_timeout(60)
        self.resize(width, height)

    def close(self):
        self.driver.quit()
        self.profile.cleanup()

    def resize(self, width, height, mobile=False):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile})

    def media(self, **features):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": name.replace("_", "-"), "value": value} for name, value in features.items()]})

    def open(self, path):
        """Opens a file; true when the page stands, false when it shows an error."""
        self.driver.get("file://" + os.path.abspath(path))
        return self.driver.execute_async_script("window.downwash.ready.then(arguments[0])")

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def settle(self):
        """Two frames, for what is drawn once a frame."""
        self.driver.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()))")

    def complaints(self):
        return [entry for entry in self.driver.get_log("browser") if entry["level"] in ("WARNING", "SEVERE")]

    def requests(self):
        """Addresses asked for since the last call, other than files and what stands in the page itself."""
        found = []
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                url = message["params"]["request"]["url"]
                if not url.startswith(OWN_SCHEMES):
                    found.append(url)
        return found

    def screenshot(self, whole=False):
        parameters = {"format": "png"}
        if whole:
            size = self.driver.execute_cdp_cmd("Page.getLayoutMetrics", {})["cssContentSize"]
            parameters.update(captureBeyondViewport=True, clip={"x": 0, "y": 0, "width": size["width"],
                                                                "height": size["height"], "scale": 1})
        return base64.b64decode(self.driver.execute_cdp_cmd("Page.captureScreenshot", parameters)["data"])

    def pdf(self):
        a4 = {"paperWidth": 8.27, "paperHeight": 11.69}
        printed = self.driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": False, **a4})
        return base64.b64decode(printed["data"])
