"""Make film.nc: film thickness and contact geometry over the operating grid."""

from lube.stages.film import film_table
from lube.storage.netcdf import load, save
from lube.study.study import load_study
from lube.workflow.jobs import begin_job

begin_job(snakemake.log[0])
study = load_study(**snakemake.config["study"])
grid = study.operating_grid
lubricant = load(snakemake.input.lubricant, "lubricant", study)
table = film_table(
    lubricant,
    study.rough_rollers,
    grid.force,
    grid.speed,
    study.film_formulas,
    slide_to_roll_ratio=study.slips,
    **study.film_model,
)
save(table, snakemake.output[0], "film", study, [snakemake.input.lubricant])
