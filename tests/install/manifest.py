"""Holds containers/job.yaml to what its image and its two jobs need of one another, and writes their shell scripts.

manifest.py JOB.yaml USER WORKDIR FOLDER

USER and WORKDIR are the image's; FOLDER gets `render` and `merge`, the scripts, and `environment`, what the manifest sets for them.
"""

import sys

import yaml

MANIFEST, USER, WORKDIR, FOLDER = sys.argv[1:]
FATAL = [2, 3, 4, 6]  # exit codes that another try would not change


def equal(what, got, wanted):
    if got != wanted:
        sys.exit(f"failed: {what} (got {got!r}, wanted {wanted!r})")


def ends(job):
    """What the job does when a pod was sent away, and when its container, of which name, ended with which codes."""
    said = {}
    for rule in job["spec"]["podFailurePolicy"]["rules"]:
        codes = rule.get("onExitCodes")
        said[rule["action"]] = [codes["containerName"], codes["values"]] if codes else [on["type"] for on in rule["onPodConditions"]]
    return said


def check_pod(name, pod, container):
    equal(f"restartPolicy of {name}", pod["restartPolicy"], "Never")  # as podFailurePolicy asks
    equal(f"names within {name}", container["name"], name)
    equal(f"image of {name}", container["image"], "abbe")
    equal(f"shell of {name}", container["command"], ["/bin/sh", "-euc"])
    user = pod["securityContext"]
    equal(f"user of {name}", [user["runAsNonRoot"], user["runAsUser"], user["runAsGroup"], user["fsGroup"]], [True] + [int(USER)] * 3)
    confinement = {"allowPrivilegeEscalation": False, "readOnlyRootFilesystem": True, "capabilities": {"drop": ["ALL"]}}
    equal(f"confinement of {name}", container["securityContext"], confinement)
    equal(f"folder of {name}", container["workingDir"], WORKDIR)
    equal(f"mounts of {name}", container["volumeMounts"], [{"name": "render", "mountPath": WORKDIR}])
    equal(f"volumes of {name}", pod["volumes"], [{"name": "render", "persistentVolumeClaim": {"claimName": "render"}}])
    for bound in "requests", "limits":
        equal(f"{bound} of {name}", sorted(container["resources"][bound]), ["cpu", "memory"])


def environment(container):
    """The variables of a container, with what Kubernetes would take from its limits."""
    said = {}
    for variable in container["env"]:
        field = variable.get("valueFrom", {}).get("resourceFieldRef", {}).get("resource")
        said[variable["name"]] = container["resources"]["limits"][field.removeprefix("limits.")] if field else variable["value"]
    return said


with open(MANIFEST, encoding="utf-8") as file:
    JOBS = {job["metadata"]["name"].removeprefix("abbe-"): job for job in yaml.safe_load_all(file)}
equal("jobs", sorted(JOBS), ["merge", "render"])
CONTAINERS = {}
for NAME, JOB in JOBS.items():
    equal(f"kind of {NAME}", [JOB["apiVersion"], JOB["kind"]], ["batch/v1", "Job"])
    POD = JOB["spec"]["template"]["spec"]
    [CONTAINERS[NAME]] = POD["containers"]
    check_pod(NAME, POD, CONTAINERS[NAME])
    with open(f"{FOLDER}/{NAME}", "w", encoding="utf-8") as file:
        [SCRIPT] = CONTAINERS[NAME]["args"]
        file.write(SCRIPT)

RENDER, MERGE = (environment(CONTAINERS[name]) for name in ("render", "merge"))
equal("completionMode", JOBS["render"]["spec"]["completionMode"], "Indexed")
equal("completions", str(JOBS["render"]["spec"]["completions"]), RENDER["TASKS"])
equal("what merge is told", MERGE, {name: RENDER[name] for name in ("SPP", "TASKS")})
equal("ends of render", ends(JOBS["render"]), {"Ignore": ["DisruptionTarget"], "FailIndex": ["render", FATAL]})
equal("ends of merge", ends(JOBS["merge"]), {"Ignore": ["DisruptionTarget"], "FailJob": ["merge", FATAL]})
with open(f"{FOLDER}/environment", "w", encoding="utf-8") as file:
    file.writelines(f"export {name}={value}\n" for name, value in RENDER.items())
