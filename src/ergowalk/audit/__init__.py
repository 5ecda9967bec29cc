"""The audit: every residual of a stored gait, recomputed from its curves alone.

Nothing here is shared with the code that produced the gait: mechanics, foot geometry, quadrature
and symmetry are written again, in another way, so that a mistake there shows up here.
"""

from ergowalk.audit.auditor import audit
from ergowalk.audit.reading import check_readable
from ergowalk.audit.report import AuditLine, AuditReport

__all__ = ["AuditLine", "AuditReport", "audit", "check_readable"]
