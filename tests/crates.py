"""The validator of RO-Crate, which asks the network for one file: here it is given that file."""

import functools
import importlib.resources
import io
from unittest.mock import patch

import requests
import rocrate
import urllib3
from rdflib.plugins.sparql.algebra import translateQuery
from rdflib.plugins.sparql.evaluate import evalQuery
from rdflib.plugins.sparql.parser import parseQuery
from rdflib.plugins.sparql.processor import SPARQLProcessor
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


@functools.cache
def _translated(text, base, namespaces):
    return translateQuery(parseQuery(text), base, dict(namespaces))


def _query(self, text, bindings=None, namespaces=None, base=None):
    """As rdflib's, which parses the same text again each time: most of the validator's time."""
    query = _translated(text, base, tuple((namespaces or {}).items()))
    return evalQuery(self.graph, query, bindings, base)


@patch.object(SPARQLProcessor, "query", _query)
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
