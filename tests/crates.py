"""The validator of RO-Crate, which asks the network for one file: here it is given that file."""

import importlib.resources
import io

import requests
import rocrate
import urllib3
from requests.adapters import BaseAdapter
from requests_cache import CachedSession
from rocrate_validator import models, services

from lube.archive.crate import RO_CRATE

CONTEXT = f"https://w3id.org/ro/crate/{RO_CRATE}/context"


class _Shipped(BaseAdapter):
    """Answers with the context that is part of the rocrate library."""

    def send(self, request, **options):
        content = (importlib.resources.files(rocrate) / "data/ro-crate.jsonld").read_bytes()
        response = requests.Response()
        response.status_code, response.url, response.request = 200, request.url, request
        response.headers["Content-Type"] = "application/ld+json"
        response.raw = urllib3.HTTPResponse(
            body=io.BytesIO(content), status=200, preload_content=False, headers=response.headers
        )
        return response

    def close(self):
        pass


def issues_of(folder, scratch):
    """List what the validator finds wrong with the crate in a folder: its required properties."""
    cache = str(scratch / "cache")
    with CachedSession(cache, backend="sqlite", expire_after=-1) as session:
        session.mount("https://", _Shipped())
        session.get(CONTEXT)
    found = services.validate(
        models.ValidationSettings(
            rocrate_uri=str(folder),
            requirement_severity=models.Severity.REQUIRED,
            offline=True,
            cache_path=cache,
        )
    )
    return [issue.message for issue in found.get_issues()]
