#!/bin/sh
# What has become of a job, for Snakemake: `slurm_status.sh JOB` prints running, success or failed. A job that Slurm has
# forgotten (MinJobAge, 300 s) counts as failed: a part that was done after all is found done when it is tried again.
case $(scontrol show job --oneliner "$1" 2>/dev/null) in
  *JobState=COMPLETED*) echo success ;;
  *JobState=PENDING* | *JobState=CONFIGURING* | *JobState=RUNNING* | *JobState=COMPLETING* | *JobState=SUSPENDED* |\
  *JobState=REQUEUED* | *JobState=STAGE_OUT*) echo running ;;
  *) echo failed ;;
esac
